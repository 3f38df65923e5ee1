"""`course grade` and `course score` with every report at once: one run, and the same again from its recording alone."""

import json
import re
import shutil
from xml.etree import ElementTree as XML

import pytest

FILES = {"--json": "report.json", "--html": "report.html", "--gradescope": "results.json", "--junit": "junit.xml"}
HOST_KEYS = ["sandbox", "pace", "run_wall_seconds", "wall_seconds", "limits", "real_time_factor"]


def wanted(folder):
    return [part for option, name in FILES.items() for part in (option, folder / name)]


@pytest.fixture(scope="module")
def graded(tmp_path_factory, grading, root, clean):
    """A run that loses two checks, with all its reports."""
    folder = tmp_path_factory.mktemp("graded")
    outcome = grading(folder, "03", root / "solutions/03_teleop/rejected/never_stops", *wanted(folder))
    assert outcome.code == 1, outcome.output
    clean(outcome)
    return outcome


@pytest.fixture(scope="module")
def again(graded, running, tmp_path_factory):
    """The reports on its recording, made once more elsewhere."""
    folder = tmp_path_factory.mktemp("again")
    outcome = running(folder, "score", graded.recording, *wanted(folder))
    assert outcome.code == 1, outcome.output
    return outcome


def test_the_json_is_the_same_but_for_host_facts(graded, again):
    first, second = dict(graded.report), dict(again.report)
    for key in HOST_KEYS:
        assert first.pop(key) is not None
        assert second.pop(key) is None
    assert first.pop("submission").endswith(second.pop("submission"))
    assert second == first
    assert first["truth_sha256"] == first["trials"][0]["truth_sha256"]


def test_the_page_is_the_same_but_for_host_facts(graded, again):
    first, second = ((o.folder / "report.html").read_text().partition("<footer>") for o in (graded, again))
    assert second[0] == first[0]
    assert "FAIL at 6.50 s" in first[0] and first[0].count('class="map"') > 3
    assert "lockstep" in first[2] and "lockstep" not in second[2]


def test_gradescope_gets_the_same_but_for_host_facts(graded, again):
    first, second = (json.loads((o.folder / "results.json").read_text()) for o in (graded, again))
    assert first.pop("execution_time") > 0
    for key in ("sandbox", "pace"):
        del first["extra_data"][key]
    assert second == first
    assert first["score"] == 65


def test_junit_gets_the_same_but_for_host_facts(graded, again):
    first, second = (XML.parse(o.folder / "junit.xml").getroot() for o in (graded, again))
    assert first[0].get("failures") == second[0].get("failures") == "2"
    assert [XML.tostring(case) for case in first.iter("testcase")] == [
        XML.tostring(case) for case in second.iter("testcase")
    ]


def test_the_terminal_says_the_same(graded, again):
    first, second = (o.stdout[o.stdout.index("Stops and stays stopped") :] for o in (graded, again))
    assert re.sub(r"8 s simulated in .*\n", "", first) == second


def test_a_manifest_that_has_changed_is_told(graded, course, root, tmp_path):
    shutil.copytree(root / "exercises", tmp_path / "course/exercises")
    manifest = tmp_path / "course/exercises/03_teleop/grading/exercise.toml"
    manifest.write_text(f"{manifest.read_text()}\n# A word more.\n")
    outcome = course("score", graded.recording, *wanted(tmp_path), COURSE_ROOT=str(tmp_path / "course"))
    sentence = "The manifest of 03_teleop has changed since this run"
    assert outcome.code == 1
    assert outcome.words.count(sentence) == 1
    assert all(sentence in (tmp_path / name).read_text() for name in FILES.values())
    assert outcome.report["score"] == 65, "it goes on"


def test_a_manifest_that_has_not_changed_is_no_news(again):
    assert "has changed" not in again.output
    assert again.report["notes"] == []


def test_a_syntax_error_gets_every_report_too(grade, root, tmp_path):
    outcome = grade("03", root / "tests/grader/cases/syntax_error", *wanted(tmp_path))
    assert outcome.code == 1, outcome.output
    for name in FILES.values():
        assert "SyntaxError" in (tmp_path / name).read_text(), name
    assert XML.parse(tmp_path / "junit.xml").getroot()[0].get("errors") == "6"


def test_what_cannot_be_written_is_said_before_anything_runs(course, root, tmp_path):
    (tmp_path / "file").write_text("")
    solution = root / "solutions/03_teleop/teleop_node.py"
    outcome = course("grade", "03", "--submission", solution, "--out", tmp_path / "out", "--junit", tmp_path / "file/x")
    assert (outcome.code, "cannot write" in outcome.words) == (2, True), outcome.output
    assert not list(tmp_path.rglob("*.rrd"))


def test_a_submission_is_never_overwritten_by_its_report(course, root, tmp_path):
    node = tmp_path / "teleop_node.py"
    shutil.copy(root / "solutions/03_teleop/teleop_node.py", node)
    before = node.read_bytes()
    outcome = course("grade", "03", "--submission", tmp_path, "--out", tmp_path / "out", "--json", node)
    assert (outcome.code, "would overwrite what is graded" in outcome.words) == (2, True), outcome.output
    assert node.read_bytes() == before


def test_a_recording_is_never_overwritten_by_a_report_on_it(course, graded):
    before = graded.recording.read_bytes()
    outcome = course("score", graded.recording, "--html", graded.recording)
    assert (outcome.code, "would overwrite what is graded" in outcome.words) == (2, True), outcome.output
    assert graded.recording.read_bytes() == before


def test_a_terminal_that_has_gone_costs_no_report(course, graded, tmp_path):
    prelude = "import sys; sys.stdout = open('/dev/full', 'w')"
    outcome = course("score", graded.recording, "--json", tmp_path / "report.json", prelude=prelude)
    assert outcome.report["score"] == 65
    assert outcome.code and "No space left" in outcome.words
