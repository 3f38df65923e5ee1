"""The scene of a world, seen by the real client: it lists the broadcaster's topics and reads the whole message."""

import re

import pytest

from gz_course.sim.gz.msgs.text import to_text
from gz_course.sim.gz.sim.scene.graph import SceneGraph
from gz_course.sim.gz.sim.scene.message import scene_message
from gz_course.sim.gz.sim.scene.state import full_state
from gz_course.sim.gz.sim.world import World

WORLD = "lidar_room"
UNKNOWN = re.compile(r"^( *)[0-9]+(: .*| \{\n(.*\n)*?\1\})\n", re.MULTILINE)
"""How the real client prints a field that came after its release."""


@pytest.fixture(scope="module")
def messages():
    """Type name -> (text as ours, message)."""
    world = World.load(f"{WORLD}.sdf")
    world.step(20)
    return {
        "ignition.msgs.Scene": scene_message(world),
        "ignition.msgs.SerializedStateMap": full_state(world, SceneGraph(world)),
    }


def without_newer_fields(text):
    """The text without the fields that Harmonic added to what stands in a scene of this world."""
    newer = "visualize_visual|is_light_off|visibility_mask|anti_aliasing|pixel_format|triggered_topic|image_noise"
    return re.sub(rf"^( *)({newer})(: .*| \{{\n(.*\n)*?\1\}})\n", "", text, flags=re.MULTILINE)


@pytest.mark.parametrize("kind", ["ignition.msgs.Scene", "ignition.msgs.SerializedStateMap"])
def test_the_real_echo_reads_what_we_made_of_a_world(stage, messages, kind):
    participant, message = stage.participant(), messages[kind]
    participant.ask("advertise", "/look", kind)
    echo = stage.real_topic("-e", "-t", "/look", "-n", "1")
    assert participant.ask("wait", "/look")
    participant.ask("publish", "/look", messages=[message.SerializeToString().hex()])
    assert echo.wait() == 0
    wanted = without_newer_fields(to_text(message))
    assert len(wanted) > 5000
    if kind.endswith("Scene"):
        assert UNKNOWN.sub("", echo.out) == wanted + "\n"
    else:  # the entries of a map come in any order
        assert sorted(echo.out.splitlines()) == sorted((wanted + "\n").splitlines())


def test_both_list_a_running_world(stage, until):
    stage.gz("sim", "-s", "-r", f"{WORLD}.sdf")
    topics = {f"/world/{WORLD}/{name}" for name in ("pose/info", "dynamic_pose/info", "scene/info", "state")}
    services = {f"/world/{WORLD}/{name}" for name in ("scene/info", "scene/graph", "state", "state_async")}
    for ask, wanted in (("topic", topics), ("service", services)):
        real = getattr(stage, f"real_{ask}")

        def complete(out, wanted=wanted):
            return wanted <= set(out.split())

        assert complete(until(lambda real=real: real("-l"), complete)[1])
        assert complete(until(lambda ask=ask: stage.gz(ask, "-l"), complete)[1])
    _, information, _ = until(
        lambda: stage.real_service("-i", "-s", f"/world/{WORLD}/scene/info"), lambda out: "tcp" in out
    )
    assert ", gz.msgs.Empty, gz.msgs.Scene" in information


def test_our_commands_look_at_a_running_world(stage):
    stage.gz("sim", "-s", f"{WORLD}.sdf")
    call = ("--reqtype", "gz.msgs.Empty", "--reptype", "gz.msgs.Scene", "--timeout", "15000", "--req", "")
    looked = stage.gz("service", "-s", f"/world/{WORLD}/scene/info", *call)
    assert looked.wait() == 0, looked.error
    assert looked.out.startswith(f'name: "{WORLD}"\n')
    assert 'name: "pillar"' in looked.out
    poses = stage.gz("topic", "-e", "-t", f"/world/{WORLD}/pose/info", "-n", "1")  # also while it is paused
    assert poses.wait() == 0, poses.error
    assert poses.out.count("pose {") > 20
