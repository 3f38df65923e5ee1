"""What the levels have in common, and what they are said not to hold."""

import os
import tomllib

import pytest

from gz_course.grader.run.sandbox.probe import try_level

from .conftest import ORDINARY, ROOT
from .test_hostile import CASES, NAMES

NO_ATTACKS = True


def test_what_a_level_does_not_hold_is_documented():
    guide = " ".join((ROOT / "docs/instructors.md").read_text().split())
    assert "prevents accidents, but not attacks" in guide
    for case in NAMES:
        want = tomllib.loads((CASES / case / "expected.toml").read_text())
        for level in ("A", "B", "C", "D"):
            assert want.get(level, {}).get("documented", "") in guide, case


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
