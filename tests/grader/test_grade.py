"""Several trials of one grading: a recording each, one score, and the same one from the recordings alone."""

import json

import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.grade import grade_again, recordings_in

X = "truth/robot/x"


@pytest.fixture
def recorded(record, root):
    """The path of a recording of exercise 03 without anything in it, of a trial."""

    def make(trial="public", number=1, count=1, **more):
        given = {"exercise": "03_teleop", "trial": trial, "trial_number": number, "trial_count": count}
        return record({X: [(0, 0.0)]}, **(given | {"submission_sha256": "abc"} | more)).path

    return make


def test_recordings_are_put_into_the_order_of_their_trials(recorded, root):
    second, first = recorded("b", 2, 2, seed=5), recorded("a", 1, 2)
    report = grade_again([second, first], root)
    assert [(t.name, t.seed, t.recording) for t in report.trials] == [("a", 0, first), ("b", 5, second)]
    assert report.recording == first
    assert grade_again([first, second], root) == report


def test_a_folder_stands_for_the_recordings_in_it(recorded, root):
    first, second = recorded("a", 1, 2), recorded("b", 2, 2)
    assert recordings_in(first.parent) == sorted([first, second])
    assert [trial.name for trial in grade_again(first.parent, root).trials] == ["a", "b"]
    alone = grade_again(first, root)
    assert alone.trials[0].name == "a", "one of them alone is scored alone"
    assert any("This is the trial a alone, one of 2" in note for note in alone.notes)


@pytest.mark.parametrize(
    ("one", "other", "told"),
    [
        ({"count": 3}, {"trial": "b", "count": 3}, r"these are 2 of 3 trials \(public, b\); give all recordings"),
        ({"count": 2}, {"count": 2}, "two of these recordings are of the same trial, public"),
        ({}, {"trial": "b", "exercise": "04_lidar_listener"}, "are of different exercises"),
        ({}, {"trial": "b", "submission_sha256": "def"}, "are of different submissions"),
        ({"count": 2}, {"trial": "b", "count": 3}, "are of different gradings"),
    ],
)
def test_recordings_that_do_not_belong_together(recorded, root, one, other, told):
    with pytest.raises(UsageError, match=told):
        grade_again([recorded(**one), recorded(**other)], root)


def test_a_folder_without_recordings(tmp_path):
    (tmp_path / "notes.txt").touch()
    with pytest.raises(UsageError, match="no recording"):
        grade_again(tmp_path)


@pytest.mark.proof
def test_what_was_learnt_by_heart_is_found_out_by_hidden_trials(grade, course, root):
    """The whole way: full marks in public, few points where the world is another; scored again, the same."""
    replay = root / "solutions/04_lidar_listener/rejected/replays_the_public_world"
    outcome = grade("04", replay, "--trials", "all")
    assert outcome.code == 1
    report = outcome.report
    assert [(trial["name"], trial["score"]) for trial in report["trials"]] == [
        ("public", 100),
        ("from_the_north", 10),
        ("turning_back", 10),
    ]
    assert report["score"] == 10 and report["diagnosis"].startswith("In the trial from_the_north: ")
    files = sorted(path.name for path in (outcome.folder / "out").glob("*.rrd"))
    assert files == [f"04_lidar_listener.{name}.rrd" for name in ("from_the_north", "public", "turning_back")]
    again = course("score", outcome.folder / "out", "--json", outcome.folder / "again.json")
    assert again.code == 1
    second = json.loads((outcome.folder / "again.json").read_text())
    for key in ("score", "checks", "diagnosis", "truth_sha256", "outcome"):
        assert second[key] == report[key]
    hashes = [trial["truth_sha256"] for trial in report["trials"]]
    assert len(set(hashes)) == 3 and [trial["truth_sha256"] for trial in second["trials"]] == hashes
