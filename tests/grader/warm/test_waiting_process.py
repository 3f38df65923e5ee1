"""`course grade` in a terminal, with and without the helper: the same report, the same end, and nothing left behind."""

from __future__ import annotations

import json
import os
import re
import resource
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest

from gz_course.grader.process import code_stamp
from gz_course.grader.warm import client, place
from gz_course.tests.eventually import within

ROOT = Path(__file__).parents[3]
DEADLINE = 300.0
eventually = within(DEADLINE)
IMPORT = re.compile(r"^import time:.*\r?\n", re.MULTILINE)  # what Python tells of an import, if asked by the variable


class Session:
    """A user's session: a terminal, and a folder for sockets that nobody else has."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.sockets = folder / "run" / "gz-course"
        for name in ("run", "tmp"):
            (folder / name).mkdir()
        self.environment = os.environ | {
            "XDG_RUNTIME_DIR": str(folder / "run"),
            "TMPDIR": str(folder / "tmp"),
            "COURSE_ROOT": str(ROOT),
            "PYTHONPROFILEIMPORTTIME": "1",
        }

    def start(self, *arguments: str) -> Command:
        return Command([sys.executable, "-m", "gz_course.grader", *arguments], self.environment)

    def grade(self, *more: str) -> Command:
        out = self.folder / "out"
        submission = ROOT / "solutions/03_teleop"
        return self.start("grade", "03", "--submission", str(submission), "--out", str(out), *more)

    def processes(self) -> list[psutil.Process]:
        """Return all that was started here and still runs."""
        found = []
        for process in psutil.process_iter():
            try:
                told = process.environ().get("XDG_RUNTIME_DIR")
            except (psutil.Error, OSError):
                continue
            if told == str(self.folder / "run") and process.status() != psutil.STATUS_ZOMBIE:
                found.append(process)
        return found

    def helpers(self) -> list[psutil.Process]:
        return [each for each in self.processes() if "gz_course.grader.warm.waiting_process" in each.cmdline()]

    def socket(self) -> Path | None:
        """Return the socket at which a helper listens."""
        names = sorted(self.sockets.glob("*")) if self.sockets.is_dir() else []
        return next((each for each in names if each.is_socket() and each.suffix == ""), None)

    def close(self) -> None:
        for each in self.processes():
            each.kill()


class Command:
    """A command at a terminal of its own."""

    def __init__(self, words: list[str], environment: dict[str, str]) -> None:
        self.terminal, theirs = os.openpty()
        self.process = subprocess.Popen(
            words, env=environment, stdin=theirs, stdout=theirs, stderr=theirs, start_new_session=True
        )
        os.close(theirs)
        self.output = b""
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        self.code: int | None = None

    def _read(self) -> None:
        try:
            while part := os.read(self.terminal, 1 << 12):
                self.output += part
        except OSError:  # the other end is closed
            pass

    def end(self) -> Command:
        """Wait for the end."""
        self.code = self.process.wait(DEADLINE)
        self._reader.join(DEADLINE)
        os.close(self.terminal)
        return self

    @property
    def text(self) -> str:
        return IMPORT.sub("", self.output.decode(errors="replace"))

    @property
    def has_imported(self) -> bool:
        """Whether it has done the imports of a grading itself."""
        return re.search(rb"^import time:.*\| +rclpy\r?$", self.output, re.MULTILINE) is not None


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Session]:
    made = Session(tmp_path)
    yield made
    made.close()


@pytest.fixture
def warm(session: Session) -> Session:
    """Return a session with a helper that listens."""
    assert session.grade().end().code == 0
    eventually(session.socket, "a helper listens")
    return session


def measured(report: Path) -> Any:
    """Return a report without what differs from machine to machine."""
    content = json.loads(report.read_text())
    for key in ("run_wall_seconds", "wall_seconds", "real_time_factor"):
        assert content.pop(key) > 0
    return content


def test_it_is_kept_after_a_grading_and_does_the_next_one(session: Session) -> None:
    cold = session.grade("--json", str(session.folder / "cold.json")).end()
    assert cold.code == 0, cold.text
    assert cold.has_imported
    eventually(session.socket, "a helper listens")
    warm = session.grade("--json", str(session.folder / "warm.json")).end()
    assert (warm.code, warm.has_imported) == (0, False), warm.text
    assert measured(session.folder / "warm.json") == measured(session.folder / "cold.json")
    assert [line for line in warm.text.splitlines() if "simulated in" not in line] == [
        line for line in cold.text.splitlines() if "simulated in" not in line
    ]
    (helper,) = eventually(lambda: len(found := session.processes()) == 1 and found, "only the helper is left")
    assert helper.cwd() == "/" and not list((session.folder / "tmp").iterdir())


def test_without_it_if_asked(warm: Session) -> None:
    assert warm.grade("--no-helper").end().has_imported


def test_an_interrupt_ends_the_grading_as_ever(warm: Session) -> None:
    command = warm.grade()
    eventually(lambda: list((warm.folder / "out").glob("*.part")), "a recording has begun")
    command.process.send_signal(signal.SIGINT)
    command.end()
    assert command.code == 130
    assert not list((warm.folder / "out").glob("*.part"))
    eventually(lambda: len(warm.processes()) == 1, "only the helper is left")


def test_a_grading_ends_with_its_command(warm: Session) -> None:
    command = warm.grade()
    eventually(lambda: list((warm.folder / "out").glob("*.part")), "a recording has begun")
    command.process.kill()
    command.end()
    eventually(lambda: len(warm.processes()) == 1, "the grading ends")
    assert not list((warm.folder / "out").glob("*.part"))


def test_a_helper_that_was_killed_costs_nothing(warm: Session) -> None:
    command = warm.grade()
    eventually(lambda: list((warm.folder / "out").glob("*.part")), "a recording has begun")
    for each in warm.helpers():
        each.kill()
    assert command.end().code == 0, "what it has begun goes on"
    again = warm.grade().end()
    assert again.code == 0 and again.has_imported, "its socket is there, and nobody listens"


def test_a_grading_that_was_killed_is_done_again(warm: Session) -> None:
    command = warm.grade()
    (begun,) = eventually(
        lambda: [each for each in warm.processes() if each.ppid() == warm.helpers()[0].pid], "it begins"
    )
    begun.kill()
    assert command.end().code == 0
    assert "the helper's grading was ended; it is done again without the helper" in command.text


def test_a_folder_that_others_may_enter_is_not_used(session: Session) -> None:
    session.sockets.mkdir()
    session.sockets.chmod(0o770)
    refused = session.start("grade", "99").end()
    assert refused.code == 2
    assert f"no helper is used, so each grading begins with its imports: {session.sockets}: " in refused.text
    assert "others may enter it" in refused.text


def test_a_folder_that_cannot_be_made(session: Session) -> None:
    (session.folder / "run").rmdir()
    refused = session.start("grade", "99").end()
    assert refused.code == 2 and "no helper is used" in refused.text and "No such file or directory" in refused.text


def test_it_ends_when_nobody_needs_it(session: Session, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in session.environment.items():
        monkeypatch.setenv(name, value)
    folder = place.open_folder()
    try:
        for left in ("dead", "dead.lock"):  # of one that was killed
            (session.sockets / left).touch()
        start = client.prepared(folder, "name", idle=0.01)
        start()
        start()  # which nobody reads
        eventually(session.helpers, "it does its imports")
        eventually(lambda: not session.helpers(), "it has ended")
        assert not session.sockets.exists()
    finally:
        os.close(folder)


def test_what_is_never_started_ends_with_its_starter(session: Session) -> None:
    assert session.start("grade", "99").end().code == 2
    eventually(lambda: not session.processes(), "nothing is left")


def test_who_has_no_terminal_does_all_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "isatty", lambda stream: True)
    assert client.wants_helper(["grade", "03"])
    assert not client.wants_helper(["grade", "03", "--no-helper"])
    assert not client.wants_helper(["list"])
    monkeypatch.setattr(os, "isatty", lambda stream: stream == 2)
    assert not client.wants_helper(["grade", "03"])


def test_other_code_other_limits_and_other_variables_have_another_helper(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    code = tmp_path / "sim.py"
    code.write_text("one\n")
    monkeypatch.setattr(code_stamp.sim, "__path__", [str(tmp_path)])
    before = place.socket_name()
    assert before == place.socket_name()
    monkeypatch.setenv("COLUMNS", "47")
    assert before == place.socket_name(), "what is read at each grading"
    os.utime(code, ns=(1, 1))
    changed = place.socket_name()
    assert changed != before
    monkeypatch.setenv("PYTHONHASHSEED", "47")
    assert place.socket_name() != changed
    monkeypatch.delenv("PYTHONHASHSEED")
    soft, hard = resource.getrlimit(resource.RLIMIT_CORE)
    resource.setrlimit(resource.RLIMIT_CORE, (0 if soft else min(1024, hard) if hard >= 0 else 1024, hard))
    try:
        assert place.socket_name() != changed or hard == 0
    finally:
        resource.setrlimit(resource.RLIMIT_CORE, (soft, hard))
