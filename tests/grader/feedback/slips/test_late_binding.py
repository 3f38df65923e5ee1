"""Functions made in a loop that read its variable when it is over, and those that keep their value."""

import ast

import pytest

from gz_course.grader.feedback.launch_files import launch_places
from gz_course.grader.feedback.slips import slips
from gz_course.grader.feedback.slips.language.shared_objects import late_bound

LOOP = "for number in range(3):\n    "


@pytest.mark.parametrize(
    ("source", "name"),
    [
        (LOOP + "steps.append(OpaqueFunction(function=lambda context: [create(number)]))", "number"),
        (LOOP + "robot = f'robot{number}'\n    node.create_timer(0.1, lambda: drive(robot))", "robot"),
        (LOOP + "def start(context):\n        return [create(number)]\n    OpaqueFunction(function=start)", "number"),
        ("[OpaqueFunction(function=lambda context: [create(n)]) for n in range(3)]", "n"),
        (LOOP + "node.create_subscription(Odometry, f'/{number}', lambda m: self.on(m, number), 10)", "number"),
    ],
)
def test_a_function_that_reads_the_variable_too_late(source, name):
    ((_, said),) = late_bound(ast.parse(source))
    assert f"gets the last value of {name}." in said and f"{name}={name}" in said


@pytest.mark.parametrize(
    "source",
    [
        LOOP + "steps.append(OpaqueFunction(function=lambda context, number=number: [create(number)]))",
        LOOP + "steps.append(OpaqueFunction(function=partial(start, number)))",
        LOOP + "steps.append(OpaqueFunction(function=started(number)))",
        LOOP + "node.create_timer(0.1, lambda: drive(other))",
        LOOP + "nearest = min(places, key=lambda place: place[number])",
        LOOP + "OpaqueFunction(function=lambda context: [create(number) for number in range(2)])",
        LOOP + "self.create_timer(0.1, lambda: drive(number))\n    break",
        "OpaqueFunction(function=lambda context: [create(number) for number in range(2)])",
    ],
)
def test_a_function_that_keeps_its_value_or_is_called_at_once(source):
    assert list(late_bound(ast.parse(source))) == []


def test_nodes_and_launch_files_are_asked():
    node = (LOOP + "node.create_timer(0.1, lambda: drive(number))").encode()
    assert "this lambda reads number" in slips(node)[0]["said"]
    launch = (LOOP + "print(OpaqueFunction(function=lambda context: [create(number)]))").encode()
    assert "this lambda reads number" in launch_places(launch)["launch_slips"][0]["said"]
