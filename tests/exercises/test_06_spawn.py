"""What is said about a robot that the simulator warns of."""

from importlib import import_module
from types import SimpleNamespace

import pytest

CHECKS = import_module("gz_course.exercises.06_spawn.grading.robot_checks")


@pytest.mark.parametrize(("lowest", "words"), [(-0.06, "caster, is 0.06 m below its origin"), (0.0, "")])
def test_a_robot_that_starts_in_the_ground(lowest, words):
    robot = SimpleNamespace(lowest_link=lambda: SimpleNamespace(lowest=lowest, lowest_part="caster"))
    found = CHECKS._in_the_ground(robot)
    assert words in found and bool(words) == bool(found)


def test_a_robot_that_is_not_known_is_not_in_the_ground():
    assert CHECKS._in_the_ground(None) == ""
