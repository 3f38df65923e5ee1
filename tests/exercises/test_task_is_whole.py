"""The README of an exercise tells every number and every name that its checks judge by.

A number may be told in any unit: 0.18 m or 18 cm, 0.9 or 90 %. What is not the student's business is left out here,
with a reason.
"""

import re

import pytest

from gz_course.grader.exercise import exercise_names
from gz_course.grader.exercise.grading import GRADING, README
from gz_course.tests.exercises.judged_by import judged_by
from gz_course.tests.exercises.told import Told
from gz_course.tests.import_arrows import ROOT

FINER = "how fine the steps of /clock are decides nothing: no check counts them"
EXPLAINS = "it only decides which explanation the feedback gives"
FOUND = "finding it is the task"
# Reasons by a pattern of (exercise, where it stands).
LEFT_OUT = {
    r"\w+ \w+\.LONGEST_\w+": "it only shortens what a report quotes",
    r"02_launch run\.observe\..*": "the stopwatch is given",
    r"04_lidar_listener logs_\w+\.tolerance": "0.01 m, and what two decimals lose in binary",
    r"05_yaml_bridge \w+\.(gz_topic|gz_type|direction)": FOUND,
    r"06_spawn run\.observe\..*": "robot_state_publisher publishes it, and its type is always the same",
    r"06_spawn robot_checks\.DRIVEN": "a robot that does not drive need not turn its wheels",
    r"06_spawn (stands\.(FALLEN|FASTEST)|drives\.LIFTED)": EXPLAINS,
    r"09_closed_loop wall\.SPACING": "so densely the simulator's walls are measured",
    r"09_closed_loop wall\.APPROACHED": EXPLAINS,
    r"10_actions patrol_run\.NEAR": "0.15 m, and the 2 cm that the task allows for odometry",
    r"10_actions patrol_checks\.STILL": EXPLAINS,
    r"(06|09|10|11|12)_\w+ run\.tick": FINER,
    r"11_many_robots convoy_checks\.STEPS": EXPLAINS,
    r"12_debugging run\.observe\..*": "finding the topics of the system is the task",
    r"13_capstone (checks\.FITS|exploring\.MOVED|rate\.(FEWEST|MOSTLY))": EXPLAINS,
}
each_exercise = pytest.mark.parametrize("name", exercise_names(ROOT))


def task(name):
    return (ROOT / "exercises" / name / README).read_text()


def judged(name):
    return list(dict.fromkeys(judged_by(ROOT / "exercises" / name / GRADING)))


def untold(name, text, facts):
    """Return the places of what a text does not tell, and what has no reason to be left out."""
    told = Told(text)
    missing = [(where, what) for where, what in facts if not any(map(told.has, written(where, what)))]
    return [f"{where} = {what}" for where, what in missing if not reason(name, where)]


def written(where, what):
    """Return how a fact may be written: the steps of a clock are told as a period [s] or as a rate [1/s]."""
    return [what, 1 / what] if where == "run.tick" else [what]


def reason(name, where):
    return next((why for pattern, why in LEFT_OUT.items() if re.fullmatch(pattern, f"{name} {where}")), "")


@each_exercise
def test_the_task_tells_all_that_the_checks_judge_by(name):
    assert untold(name, task(name), judged(name)) == []


@each_exercise
def test_a_task_that_tells_another_number_or_name_is_found_out(name):
    """Each number and each name is changed in turn, as if the manifest were; most are then told nowhere."""
    facts = [(where, what) for where, what in judged(name) if not reason(name, where)]
    changed = [(where, what * 1.37 if isinstance(what, float) else f"{what}_2") for where, what in facts if what]
    assert changed and len(untold(name, task(name), changed)) == len(changed)


def test_what_is_left_out_is_there_and_is_not_told():
    places = [f"{name} {where}" for name in exercise_names(ROOT) for where, _ in judged(name)]
    assert [pattern for pattern in LEFT_OUT if not any(re.fullmatch(pattern, place) for place in places)] == []


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("within 18 cm", 0.18),
        ("for 4 mm", 0.004),
        ("at least 90 % of the way", 0.9),
        ("95 of 100 scans", 0.95),
        ("nine of ten", 0.9),
        ("for five seconds", 5.0),
        ("half of them", 0.5),
        ("at most 0.02 m/s", -0.02),
        ("180 degrees", 3.141592653589793),
    ],
)
def test_a_number_is_told_in_any_unit(text, number):
    assert Told(text).has(number) and not Told(text).has(number * 1.37)


@pytest.mark.parametrize("text", ["| points |\n\n## Points\n\n| 15 |", "version 1.15", "15.5 m", "x15"])
def test_what_is_no_number_of_the_task(text):
    assert not Told(text).has(15.0)
