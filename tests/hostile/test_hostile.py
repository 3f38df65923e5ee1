"""Submissions that mean harm: each folder in `cases/` attacks before it drives as it should, or instead.

`attack.py` is imported by an otherwise honest submission. It prints a line with ESCAPED for whatever it should not
have been able to do, and one beginning with `held` for what it has tried in vain. `expected.toml` has the `outcomes`
that are right, `points`, `words` of the diagnosis, and `tried`: how many `held` there must be at least, so that an
attack that never took place is no success. Afterwards the same worker must give full marks to an honest submission.
"""

import os
import tomllib
from pathlib import Path

import pytest

from gz_course.grader.run.sandbox.probe import try_level

from .conftest import ORDINARY

CASES = Path(__file__).parent / "cases"
NAMES = sorted(path.parent.name for path in CASES.glob("*/expected.toml"))
ROOT_ONLY = pytest.mark.skipif(os.getuid() != 0, reason="only root can become an ordinary user")
KINDS = [
    pytest.param(("A", None), id="A"),
    pytest.param(("A", ORDINARY), id="A-ordinary-user", marks=[ROOT_ONLY, pytest.mark.proof]),
    pytest.param(("B", ORDINARY + 1), id="B-ordinary-user", marks=[ROOT_ONLY, pytest.mark.proof]),
]


@pytest.fixture(scope="session", params=KINDS)
def worker(request, workers):
    level, user = request.param
    if user is None and (lack := try_level(level)):
        pytest.skip(f"no level {level} here: {lack}")
    return workers(level, user)


@pytest.mark.parametrize("case", NAMES)
def test_an_attack_comes_to_nothing(case, worker, solution):
    want = tomllib.loads((CASES / case / "expected.toml").read_text())
    attack = (CASES / case / "attack.py").read_text()
    told = worker.grade({"teleop_node.py": f"import attack\n{solution}", "attack.py": attack})
    report, log = told["report"], told["log"]
    assert [line for line in log if "ESCAPED" in line] == []
    assert report["outcome"] in want["outcomes"], (report["diagnosis"], log[-20:])
    assert report["score"] == want["points"], (report["diagnosis"], log[-20:])
    assert report["sandbox"] == worker.level
    assert all(word in report["diagnosis"] for word in want.get("words", [])), report["diagnosis"]
    assert sum(line.startswith("held") for line in log) >= want.get("tried", 0), log
    assert told["children"] == []

    honest = worker.grade({"teleop_node.py": solution})
    assert (honest["report"]["score"], honest["report"]["pace"]) == (100, "lockstep"), honest["report"]["diagnosis"]
    assert honest["children"] == [] and worker.left() == []
    # Nothing grows from one grading to the next.
    assert honest["descriptors"] <= told["descriptors"]
    assert (honest["network"], honest["mounts"]) == (told["network"], told["mounts"])


@pytest.mark.proof
def test_the_truth_is_the_same_at_every_level(workers, solution):
    """The same submission moves the robot in the same way, however it is locked in."""
    levels = ["A", "B", "C", "D"]
    kinds = [(level, None) for level in levels if level == "D" or not try_level(level)]
    if os.getuid() == 0:
        kinds.append(("A", ORDINARY))
    told = {kind: workers(*kind).grade({"teleop_node.py": solution}) for kind in kinds}
    assert {t["report"]["score"] for t in told.values()} == {100}
    assert len({t["report"]["truth_sha256"] for t in told.values()}) == 1
    assert len({"\n".join(t["log"]) for t in told.values()}) == 1
