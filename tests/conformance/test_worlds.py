"""SDF worlds against libsdformat, which Gazebo reads them with: every model, link, collision, joint, axis and light
stands in the same place, every joint connects the same links.

Needs Debian's `libsdformat-dev` and `g++`; skipped where they are missing.
"""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.pose import Pose, rotate
from gz_course.sim.gz.sim.sdf.reader import read_world
from gz_course.tests.conformance.libsdformat import libsdformat
from gz_course.tests.conformance.random_worlds import WorldMaker

NEEDS_CLIENT = False


@pytest.fixture(scope="module")
def sdformat(tmp_path_factory):
    with libsdformat("sdformat_world.cc", tmp_path_factory.mktemp("oracle")) as read:
        yield read


def ours(text: str, path: Path) -> dict[tuple[str, str], Pose]:
    """Where everything stands in the world as it was read here."""
    diagnostics = Diagnostics(strict=True)
    world = read_world(text, str(path), diagnostics)
    diagnostics.refuse()
    found: dict[tuple[str, str], Pose] = {}
    for model in world.models:
        found["model", model.name] = model.pose
        for nested in model.nested:
            found["model", f"{model.name}::{nested.name}"] = model.pose * nested.pose
        poses = {}
        for link in model.links:
            poses[link.name] = model.pose * link.pose
            found["link", f"{model.name}::{link.name}"] = poses[link.name]
            for part in link.collisions:
                found["collision", f"{model.name}::{link.name}::{part.name}"] = poses[link.name] * part.pose
        for joint in model.joints:
            name = f"{model.name}::{joint.name}"
            found["joint", name] = poses[joint.child] * joint.pose
            scope = joint.name.rpartition("::")[0]
            for role, link in (("child", joint.child), ("parent", joint.parent)):
                found[role, f"{name}={link.removeprefix(f'{scope}::' if scope else '')}"] = Pose()
            for number, axis in enumerate((joint.axis, joint.axis2)):
                if axis is not None:
                    found[f"axis{number}", name] = Pose(rotate(poses[joint.child].quaternion, np.array(axis.direction)))
    for light in world.lights:
        found["light", light.name] = light.pose
    return found


@settings(deadline=None, max_examples=60, suppress_health_check=list(HealthCheck))
@given(st.integers(0, 10**9))
def test_random_worlds_are_what_gazebo_makes_of_them(sdformat, tmp_path, seed) -> None:
    text = WorldMaker(seed, tmp_path).world()
    path = tmp_path / "world.sdf"
    path.write_text(text)
    expected = sdformat(path)
    assert not expected["errors"], expected["errors"]
    wanted = {(kind, name): Pose(numbers[:3], numbers[3:]) for kind, name, *numbers in expected["found"]}
    made = ours(text, path)
    assert made.keys() == wanted.keys()
    # libsdformat writes the poses of includes with six digits.
    tolerance = 1e-3 if "<include" in text else 1e-9
    for key, pose in made.items():
        assert pose.is_close(wanted[key], tolerance), (key, pose, wanted[key])
