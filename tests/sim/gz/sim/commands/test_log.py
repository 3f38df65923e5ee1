"""`gz log record` and `gz log playback`, in this process."""

from __future__ import annotations

import queue
import re
import threading
import uuid
from pathlib import Path
from typing import Any

import pytest

from gz_course.sim.gz.command import main
from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.sim.commands.log import Recorder, play
from gz_course.sim.gz.sim.tlog import Entry, Log, LogWriter
from gz_course.sim.gz.transport import Node, NodeOptions, Scope


@pytest.fixture(autouse=True)
def partition(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GZ_IP", "127.0.0.1")
    monkeypatch.setenv("GZ_PARTITION", uuid.uuid4().hex)


@pytest.fixture
def log(tmp_path: Path) -> Path:
    path = tmp_path / "state.tlog"
    writer = LogWriter(path)
    for number in range(3):
        writer.write(Entry("/speed", "gz.msgs.Double", number * 5 * 10**12, Double(data=number).SerializeToString()))
    writer.write(Entry("/other", "gz.msgs.StringMsg", 10**13, StringMsg(data="x").SerializeToString()))
    writer.close()
    return path


def test_what_is_recorded_is_played_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "all.tlog"
    with Node() as node, Recorder(path, re.compile("/spee.*")) as recorder:
        publisher, hidden = node.advertise("/speed", Double), node.advertise("/hidden", Double)
        assert recorder.look() and recorder.topics == {"/speed"}
        heard: queue.Queue[Any] = queue.Queue()
        node.subscribe(Double, "/speed", heard.put)
        for number in range(3):
            hidden.publish(Double(data=number))
            publisher.publish(Double(data=number))
        assert [heard.get(timeout=120).data for _ in range(3)] == [0, 1, 2]
    assert recorder.count == 3
    log, played = Log(path), []
    assert [(each.topic, each.type_name, each.count) for each in log.topics()] == [("/speed", "gz.msgs.Double", 3)]
    with Node(NodeOptions(scope=Scope.PROCESS)) as node:
        node.subscribe(Double, "/speed", lambda message: played.append(message.data))
        assert play(log, node, re.compile(".+"), 0.0, 0.0, lambda seconds: None) == 3
    assert played == [0, 1, 2]
    log.close()


def test_playback_keeps_the_intervals(log: Path) -> None:
    pauses: list[float] = []
    opened = Log(log)
    with Node(NodeOptions(scope=Scope.PROCESS)) as node:
        assert play(opened, node, re.compile("/speed"), 0.25, 1.0, pauses.append) == 3
    assert pauses[0] == 0.25
    assert 9_000 < pauses[-1] <= 10_000  # nothing waits here
    opened.close()


def test_the_command_plays_back_under_another_name(log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    heard = threading.Event()
    with Node() as node:
        node.subscribe(StringMsg, "/renamed", lambda message: heard.set())
        assert main(["log", "playback", "--file", str(log), "--wait", "0", "-f", "--remap", "/other:=/renamed"]) == 0
        assert heard.wait(120)
    assert capsys.readouterr().out == "4 messages were played back.\n"


def test_nonsense(log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for arguments, sentence in (
        (["record", "--file", str(log)], "--force overwrites it"),
        (["record", "--pattern", "("], "is not a regular expression"),
        (["playback"], "needs --file"),
        (["playback", "--file", str(log / "nothing")], "there is no log"),
        (["playback", "--file", str(log), "--pattern", "/spee"], "has no topic that matches"),
        (["playback", "--file", str(log), "--remap", "/a"], "FROM:=TO"),
    ):
        assert main(["log", *arguments]) == 1
        assert sentence in capsys.readouterr().err
    assert main(["log"]) == 0
    assert "record" in capsys.readouterr().out
