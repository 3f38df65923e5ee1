"""`gz tlog` prints the content of a recording, and an error if there is none."""

from __future__ import annotations

from pathlib import Path

import pytest

from gz_course.sim.gz.command import main
from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.sim.tlog import Entry, LogWriter


@pytest.fixture
def log(tmp_path: Path) -> Path:
    writer = LogWriter(tmp_path / "state.tlog")
    for number in range(3):
        writer.write(Entry("/speed", "gz.msgs.Double", number * 500_000_000, Double(data=number).SerializeToString()))
    writer.close()
    return tmp_path


def test_info(log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tlog", "-i", str(log)]) == 0
    out = capsys.readouterr().out
    assert "End:        1.000 s" in out and "  /speed [gz.msgs.Double] 3\n" in out


def test_echo(log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tlog", "-e", str(log / "state.tlog"), "-t", "/speed"]) == 0
    assert capsys.readouterr().out == "\n".join(["", "data: 1", "", "data: 2", "", ""])
    assert main(["tlog", "-e", str(log), "-t", "/speed", "-n", "2"]) == 0
    assert capsys.readouterr().out.count("data") == 1


def test_nonsense(log: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tlog", "-e", str(log), "-t", "/sped"]) == 1
    assert "did you mean '/speed'" in capsys.readouterr().err
    assert main(["tlog", "-i", str(log / "nothing")]) == 1
    assert "there is no log" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["tlog", "-e", str(log)])
    assert "requires --topic" in capsys.readouterr().err
