"""Right nodes in awkward styles: each earns full marks; `make prove-determinism` grades each of them often.

They are the folders of `run/styles/`: threads, executors, asyncio, several processes, modules beside the file.
"""

from pathlib import Path

import pytest

from gz_course.grader.exercise import exercise_names, find_exercise

ROOT = Path(__file__).parents[2]
STYLES = ROOT / "tests/grader/run/styles"
QUICK = "helper_package"
NAMES = [
    pytest.param(path.name, marks=() if path.name == QUICK else [pytest.mark.proof])
    for path in sorted(STYLES.iterdir())
    if path.is_dir()
]


@pytest.mark.parametrize("name", NAMES)
def test_a_right_node_in_another_style_earns_full_marks(name, grade):
    exercises = (find_exercise(each, ROOT) for each in exercise_names(ROOT))
    exercise = next(each for each in exercises if (STYLES / name / each.file).is_file())
    outcome = grade(exercise.name, STYLES / name)
    assert (outcome.code, outcome.report["score"]) == (0, 100), outcome.words
