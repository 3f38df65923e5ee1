"""The numbers by which a class is ranked: in the manifest, in the report, and for Gradescope."""

import dataclasses
import json
import math

import pytest

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import CheckSpec
from gz_course.grader.exercise.leaderboard import HIGHEST, LOWEST, Ranked, read_leaderboard
from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.report.formats.gradescope import as_gradescope
from gz_course.grader.report.ranking import Place, places
from gz_course.grader.score.check import Finding
from gz_course.grader.score.consequences import CheckResult
from gz_course.grader.score.score import Score

TIME = Ranked("Time [s]", "time", LOWEST)
SPEC = CheckSpec("time", "Time", 10, "time_in_band", ("",))


def score(value, passed=True):
    return Score((CheckResult(SPEC, Finding(passed, "", "", value=value)),), "graded", "", "")


@pytest.mark.parametrize(
    ("scores", "best", "value"),
    [
        ([score(4.0)], LOWEST, 4.0),
        ([score(4.0), score(6.0)], LOWEST, 6.0),
        ([score(4.0), score(6.0)], HIGHEST, 4.0),
        ([score(4.0), score(6.0, passed=False)], LOWEST, None),
        ([score(4.0), score(None)], LOWEST, None),
        ([score(math.inf)], LOWEST, None),
        ([], LOWEST, None),
    ],
)
def test_the_worst_of_all_trials_counts_of_who_passes(scores, best, value):
    found = places([dataclasses.replace(TIME, best=best)], scores)
    assert found == (() if value is None else (Place("Time [s]", value, best),))


def test_a_report_has_it_and_gradescope_gets_it(make_report):
    report = dataclasses.replace(make_report(), leaderboard=places([TIME], [score(4.25)]))
    assert json.loads(report.as_json())["leaderboard"] == [{"name": "Time [s]", "value": 4.25, "best": "lowest"}]
    told = json.loads(as_gradescope(report))["leaderboard"]
    assert told == [{"name": "Time [s]", "value": 4.25, "order": "asc"}]
    assert "leaderboard" not in json.loads(as_gradescope(make_report()))


def test_what_a_manifest_says(tmp_path):
    file = tmp_path / "m.toml"
    file.write_text('[[leaderboard]]\nname = "Time [s]"\ncheck = "time"\nbest = "lowest"\n')
    assert read_leaderboard(Table.load(file).tables("leaderboard")) == (TIME,)
    for wrong in ('best = "lowets"', 'best = "lowest"\nunit = "s"'):
        file.write_text(f'[[leaderboard]]\nname = "Time [s]"\ncheck = "time"\n{wrong}\n')
        with pytest.raises(ManifestError, match=r"lowest|unit"):
            read_leaderboard(Table.load(file).tables("leaderboard"))
