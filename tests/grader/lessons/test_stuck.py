"""The help on a failed check in a notebook: buttons that run the commands, or the commands in words."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

from gz_course.grader.lessons import stuck
from gz_course.grader.lessons.stuck import Stuck


@pytest.fixture
def help_on(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Stuck:
    """Help whose commands print what they were asked."""
    monkeypatch.setattr(stuck, "COMMAND", (sys.executable, "-c", "import sys; print('<', *sys.argv[1:])"))
    return Stuck("03_teleop", tmp_path)


def test_without_widgets_the_commands_are_told(
    help_on: Stuck, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "ipywidgets", None)
    help_on._ipython_display_()
    said = capsys.readouterr().out
    assert "!course hint 03_teleop   where to look" in said and "!course explain 03_teleop" in said


def test_a_button_runs_its_command(help_on: Stuck) -> None:
    pytest.importorskip("ipywidgets")
    row, answer = help_on._widget().children
    labels: dict[str, Any] = {button.description: button for button in row.children}
    assert list(labels) == ["Next hint", "Which line decides?"]
    labels["Next hint"].click()
    assert "&lt; hint 03_teleop</pre>" in answer.value
    labels["Which line decides?"].click()
    assert "&lt; explain 03_teleop</pre>" in answer.value


def test_the_command_is_that_of_the_course(tmp_path: Path) -> None:
    said = Stuck("no_such_exercise", tmp_path).said("hint")
    assert "no_such_exercise" in said and "Traceback" not in said


def test_a_command_that_does_not_end_is_ended(help_on: Stuck, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stuck, "COMMAND", (sys.executable, "-c", "import threading; threading.Event().wait()"))
    monkeypatch.setattr(stuck, "_DEADLINE_S", 0.2)
    assert help_on.said("explain") == "`course explain 03_teleop` took longer than 0.2 s; run it in a terminal."
