"""LogPlayback: what LogRecord has recorded is shown again, at any time, by joints of every kind."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import pytest

from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.log_playback_control_pb2 import LogPlaybackControl
from gz_course.sim.gz.sim.commands.sim import _recorded
from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.server import Server
from gz_course.sim.gz.sim.tlog import Entry, Log, LogWriter
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

RECORD = "<plugin filename='gz-sim-log-record-system' name='gz::sim::systems::LogRecord'><record_path>{}</record_path>"
JOINTS = {
    "revolute": "<axis><xyz>0.6 0 0.8</xyz></axis>",
    "prismatic": "<axis><xyz>0 0.6 0.8</xyz><limit><lower>-0.1</lower><upper>0.1</upper></limit></axis>",
    "universal": "<axis><xyz>1 0 0</xyz></axis><axis2><xyz>0 1 0</xyz></axis2>",
    "ball": "",
}


LINKS = """<link name='a'/><link name='b'><pose>0.2 0.1 0 0.3 0 0</pose></link>
<joint name='w' type='fixed'><parent>world</parent><child>a</child></joint>"""


def text(folder: Path) -> str:
    models = "".join(
        f"<model name='{kind}'><pose>{number} 0 2 0.1 0.2 0.3</pose>{LINKS}<joint name='j' type='{kind}'>"
        f"<pose>0.1 0 0 0 0 0</pose><parent>a</parent><child>b</child>{axes}</joint></model>"
        for number, (kind, axes) in enumerate(JOINTS.items())
    )
    systems = (("Physics", "physics"), ("SceneBroadcaster", "scene-broadcaster"))
    plugins = (f"<plugin filename='gz-sim-{file}-system' name='gz::sim::systems::{name}'/>" for name, file in systems)
    return (
        f"<sdf version='1.10'><world name='w'>{''.join(plugins)}{RECORD.format(folder)}</plugin>{models}"
        "<model name='free'><pose>0 3 9 0 0 0</pose><link name='l'/></model></world></sdf>"
    )


def poses(world: World) -> dict[str, Pose]:
    found = {kind: world.truth.link_pose(kind, "b") for kind in JOINTS}
    return found | {"free": world.truth.link_pose("free", "l")}


def same(one: dict[str, Pose], other: dict[str, Pose]) -> bool:
    return all(pose.is_close(other[name], 1e-6) for name, pose in one.items())


def test_a_recording_is_shown_again(node: Node, tmp_path: Path) -> None:
    folder = tmp_path / "log"
    world = World.from_string(text(folder), node=node)
    seen = {}
    for _ in range(120):
        world.step()
        seen[world.sim_time_ns] = poses(world)
    world.close()
    log = Log(folder)
    times = sorted({each.time_ns for each in log.messages("/world/w/dynamic_pose/info")})
    log.close()
    assert len(times) > 5 and not seen[times[0]]["universal"].is_close(seen[times[-1]]["universal"], 1e-4)
    with Node(node.options) as other:
        shown, end_ns = _recorded(folder, [])
        assert end_ns == times[-1] and [each.name for each in shown.systems] == ["LogPlayback", "SceneBroadcaster"]
        server = Server(shown, other)
        server.control.end_ns = end_ns
        for time_ns in times:
            server.step((time_ns - shown.sim_time_ns) // shown.step_size_ns)
            assert same(poses(shown), seen[time_ns])
        server.control.stepped(1)
        assert server.paused
        for request, time_ns in (
            ({"seek": {"nsec": times[4]}}, times[4]),
            ({"forward": True}, times[-1]),
            ({"rewind": True}, 0),
        ):
            message = LogPlaybackControl(pause=True, **request)
            with asked(node, message) as answer:
                while not answer.done():
                    shown.requests.wait(0.1)
                    shown.requests.serve()
            assert answer.result() and shown.sim_time_ns == time_ns
            assert same(poses(shown), seen[time_ns or times[0]])
    shown.close()


@contextmanager
def asked(node: Node, message: LogPlaybackControl) -> Iterator[Future[bool]]:
    """Call the service in a thread; the test itself steps the world, which answers between two steps."""

    def call() -> bool:
        done, answer = node.request("/world/w/playback/control", message, LogPlaybackControl, Boolean, 120_000)
        return bool(done and answer.data)

    with ThreadPoolExecutor(1) as pool:
        yield pool.submit(call)


@pytest.mark.parametrize(
    ("topic", "words"), [("/x", "holds no world"), ("/w/log/sdf", "has no poses on /world/w/dynamic_pose/info")]
)
def test_what_is_no_recording_of_a_world(tmp_path: Path, topic: str, words: str) -> None:
    from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg

    with pytest.raises(SimError, match="there is no log"):
        _recorded(tmp_path, [])
    writer = LogWriter(tmp_path / "state.tlog")
    data = StringMsg(data="<sdf version='1.10'><world name='w'/></sdf>").SerializeToString()
    writer.write(Entry(topic, "gz.msgs.StringMsg", 0, data))
    writer.close()
    with pytest.raises(SimError, match=words):
        _recorded(tmp_path, [])


def test_a_damaged_recording_ends_with_a_sentence(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V
    from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg

    world = "<sdf version='1.10'><world name='w'><model name='m'><link name='l'/></model></world></sdf>"
    nowhere = Pose_V()
    for number in range(1, 9):
        nowhere.pose.add(id=number).position.x = float("nan")
    writer = LogWriter(tmp_path / "state.tlog")
    writer.write(Entry("/w/log/sdf", "gz.msgs.StringMsg", 0, StringMsg(data=world).SerializeToString()))
    topic = "/world/w/dynamic_pose/info"
    writer.write(Entry(topic, "gz.msgs.Pose_V", 0, b""))
    writer.write(Entry(topic, "gz.msgs.Pose_V", 5_000_000, nowhere.SerializeToString()))
    writer.write(Entry(topic, "gz.msgs.Pose_V", 10_000_000, b"no message"))
    writer.close()
    shown, _ = _recorded(tmp_path, [])
    shown.step(20)
    assert shown.truth.pose("m").is_close(Pose()) and caplog.text.count("is damaged") == 1
    shown.close()
    (tmp_path / "state.tlog").write_bytes((tmp_path / "state.tlog").read_bytes()[:6000])
    with pytest.raises(SimError, match=r"damaged|not a log"):
        _recorded(tmp_path, [])
