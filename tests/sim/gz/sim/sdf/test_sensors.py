"""Sensors of joints after reading: pose, names in nested models, rejected input."""

from __future__ import annotations

import pytest

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.sdf.reader import read_world

MODEL = (
    "<model name='m'>{}<link name='a'/><link name='b'><pose>1 0 0 0 0 0</pose></link><frame name='f'><pose>0 5 0 0 0 0"
    "</pose></frame><joint name='j' type='fixed'><pose>0 0 2 0 0 0</pose><parent>a</parent><child>b</child>{}</joint>"
    "</model>"
)


def sensors(sensor: str, wrap: str = "{}", diagnostics: Diagnostics | None = None) -> list[Sensor]:
    text = f"<sdf version='1.10'><world name='w'>{wrap.format(MODEL.format('', sensor))}</world></sdf>"
    world = read_world(text, "<string>", diagnostics or Diagnostics())
    return world.models[0].sensors()


def test_the_pose_is_in_the_joints_frame() -> None:
    (found,) = sensors("<sensor name='s' type='force_torque'><pose>0.1 0 0 0 0 0.5</pose></sensor>")
    assert (found.name, found.kind, found.model, found.link, found.joint) == ("s", "force_torque", "m", "b", "j")
    assert found.pose.is_close(Pose.from_rpy((0.1, 0, 0), (0, 0, 0.5)))


def test_the_pose_may_be_given_in_another_frame() -> None:
    (found,) = sensors("<sensor name='s' type='force_torque'><pose relative_to='f'>0 0 0 0 0 0</pose></sensor>")
    # The joint is at (1, 0, 2) in the model, the frame at (0, 5, 0).
    assert found.pose.is_close(Pose((-1, 5, -2)))


def test_an_unknown_frame_is_warned_about() -> None:
    diagnostics = Diagnostics()
    text = "<sensor name='s' type='force_torque'><pose relative_to='g'>1 0 0 0 0 0</pose></sensor>"
    (found,) = sensors(text, diagnostics=diagnostics)
    assert found.pose.is_close(Pose((1, 0, 0))) and "names no frame" in diagnostics.warnings[0]


def test_nested_models_put_their_names_before() -> None:
    (found,) = sensors("<sensor name='s' type='force_torque'/>", wrap="<model name='top'>{}</model>")
    assert (found.model, found.link, found.joint) == ("top", "m::b", "m::j")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("<sensor type='force_torque'/>", "needs a name"),
        ("<sensor name='s'/>", "needs a type"),
        ("<sensor name='s' type='force_torque'/>" * 2, "already has a <sensor> called 's'"),
    ],
)
def test_what_is_refused(text: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence):
        sensors(text)
