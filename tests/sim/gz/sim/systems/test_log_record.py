"""LogRecord: the file contains the published messages; folders are not overwritten unless requested; schema of tlog."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest

from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.sim.errors import SdfError, SimError
from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_WORLDS
from gz_course.sim.gz.sim.tlog import Entry, Log, LogWriter
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node


def load(node: Node, parameters: str) -> World:
    text = (BUILT_IN_WORLDS / "lidar_room.sdf").read_text()
    plugin = f"<plugin filename='gz-sim-log-record-system' name='gz::sim::systems::LogRecord'>{parameters}</plugin>"
    return World.from_string(text.replace("</world>", f"{plugin}</world>"), node=node)


def test_what_was_published_is_what_is_read(node: Node, tmp_path: Path) -> None:
    folder = tmp_path / "log"
    heard: list[bytes] = []
    world = load(node, f"<record_path>{folder}</record_path><record_topic>/lidar/scan</record_topic>")
    node.subscribe_raw("/lidar/scan", lambda data, info: heard.append(data))
    world.step(1000)
    world.close()
    log = Log(folder)
    entries = list(log.messages("/lidar/scan"))
    assert len(heard) >= 10 and [entry.data for entry in entries] == heard
    for entry in entries:
        stamp = LaserScan.FromString(entry.data).header.stamp
        assert entry.time_ns == stamp.sec * 10**9 + stamp.nsec and entry.type_name == "gz.msgs.LaserScan"
    sdf = next(log.messages("/lidar_room/log/sdf"))
    assert World.from_string(StringMsg.FromString(sdf.data).data).name == "lidar_room"
    assert {each.topic for each in log.topics()} >= {"/lidar/scan", "/lidar_room/log/sdf"}
    log.close()


def test_a_model_that_comes_is_recorded_too(node: Node, tmp_path: Path) -> None:
    from gz_course.sim.gz.sim.pose import Pose
    from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_MODELS

    world = load(node, f"<record_path>{tmp_path / 'log'}</record_path><record_topic>/model/.*/odometry</record_topic>")
    world.step(200)
    text = (BUILT_IN_MODELS / "two_wheel_robot" / "model.sdf").read_text()
    world.editor.spawn(text, name="second", pose=Pose((2.0, -2.0, 0.0)))
    world.step(400)
    world.close()
    with Log(tmp_path / "log") as log:
        counts = {each.topic: each.count for each in log.topics()}
    assert counts["/model/robot/odometry"] > counts["/model/second/odometry"] > 10


def test_folders(node: Node, tmp_path: Path) -> None:
    def record(more: str) -> Path:
        world = load(node, f"<record_path>{tmp_path / 'log'}</record_path>{more}")
        world.step()
        world.close()
        return next(each for each in world.systems if each.name == "LogRecord").folder  # type: ignore[attr-defined]

    assert record("") == tmp_path / "log"
    assert record("") == tmp_path / "log(1)"
    assert record("") == tmp_path / "log(2)"
    assert record("<overwrite>true</overwrite>") == tmp_path / "log"


@pytest.mark.parametrize(
    ("parameters", "sentence"),
    [
        ("<record_topic>(</record_topic>", "not a regular expression"),
        ("<record_period>-1</record_period>", "zero or more seconds"),
        ("<record_path>/proc/nowhere</record_path>", "cannot be written"),
    ],
)
def test_nonsense(node: Node, parameters: str, sentence: str) -> None:
    with pytest.raises((SdfError, SimError), match=sentence):
        load(node, parameters)


def test_the_schema_is_gazebos(tmp_path: Path) -> None:
    """Read with plain SQL, like Gazebo's own tools."""
    writer = LogWriter(tmp_path / "state.tlog")
    for number in range(1200):
        writer.write(Entry(f"/t{number % 3}", "gz.msgs.Empty" if number % 3 else "gz.msgs.Time", number, b"x" * number))
    writer.close()
    writer.close()
    database = sqlite3.connect(tmp_path / "state.tlog")
    assert database.execute("SELECT to_version FROM migrations").fetchall() == [("0.1.0",)]
    assert database.execute("SELECT COUNT(*) FROM message_types").fetchone() == (2,)
    joined = "SELECT messages.time_recv, topics.name, message_types.name, LENGTH(messages.message) FROM messages "
    joined += "JOIN topics ON messages.topic_id = topics.id JOIN message_types ON topics.message_type_id = "
    joined += "message_types.id ORDER BY time_recv"
    assert database.execute(joined).fetchall()[7] == (7, "/t1", "gz.msgs.Empty", 7)
    assert database.execute("SELECT COUNT(*) FROM messages").fetchone() == (1200,)
    database.close()


def test_what_is_no_log(tmp_path: Path) -> None:
    with pytest.raises(SimError, match="there is no log"):
        Log(tmp_path)
    (tmp_path / "state.tlog").write_text("hello")
    with pytest.raises(SimError, match="not a log of Gazebo"):
        Log(tmp_path)
