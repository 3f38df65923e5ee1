"""`course hint`: one hint more each time, never more than the exercise shows."""

import json
import shutil

import pytest


@pytest.fixture(scope="module")
def graded(tmp_path_factory, grading, root):
    """A run that loses two checks."""
    folder = tmp_path_factory.mktemp("graded")
    outcome = grading(folder, "03", root / "solutions/03_teleop/rejected/never_stops")
    assert outcome.code == 1, outcome.output
    return outcome


@pytest.fixture
def hint(graded, tmp_path, running, monkeypatch):
    """Call `course hint` on that run, with a folder of runs of its own."""
    runs = tmp_path / "runs/03_teleop"
    runs.mkdir(parents=True)
    shutil.copy(graded.recording, runs)
    monkeypatch.setenv("COURSE_RUNS", str(runs.parent))
    return lambda *options: running(tmp_path, "hint", "03", *options)


def test_each_call_shows_one_more(hint, tmp_path):
    assert hint().output.startswith("Stops and stays stopped, hint 2 of 3: ")
    assert hint().output.startswith("Stops and stays stopped, hint 3 of 3: ")
    last = hint()
    assert last.output.startswith("Stops and stays stopped, hint 3 of 3: ") and "no further hint" in last.output
    assert hint("--check", "five_seconds").output.startswith("Drives for five seconds of simulated time, hint 2 of 3")
    shown = json.loads((tmp_path / "runs/03_teleop/hints_shown.json").read_text())
    assert shown == {"stops": 3, "five_seconds": 2}


def test_a_check_that_has_not_failed_is_refused(hint):
    said = hint("--check", "stop")
    assert (said.code, "did you mean 'stops'?" in said.output) == (2, True)


@pytest.mark.parametrize("kept", ["", "[]", '{"stops": "many"}', '{"stops": -3}', '{"stops": 99}'])
def test_what_was_kept_may_be_anything(hint, tmp_path, kept):
    (tmp_path / "runs/03_teleop/hints_shown.json").write_text(kept)
    assert hint().output.startswith("Stops and stays stopped, hint ")


def test_without_a_grading_there_is_no_hint(running, tmp_path, monkeypatch):
    monkeypatch.setenv("COURSE_RUNS", str(tmp_path))
    said = running(tmp_path, "hint", "03")
    assert (said.code, "run `course grade 03_teleop`" in said.output) == (2, True)
