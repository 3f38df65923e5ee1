"""A real grading in which rules of feedback raise: score, checks and exit code stay, and the report says it."""

import json
import os
import subprocess
import sys

import pytest

RULES = {
    "slips": ("from gz_course.grader.feedback.slips import slip as rule", "tree", "raise KeyError('odd')\n    yield"),
    "suspects": (
        "from gz_course.grader.feedback.suspects import suspicion as rule",
        "tree",
        "rule_that_calls_itself = lambda: rule_that_calls_itself()\n    rule_that_calls_itself()\n    yield",
    ),
    "errors": (
        "from gz_course.grader.feedback.errors import explanation as rule",
        "error, code",
        "raise ValueError('odd')",
    ),
}
PROGRAM = """\
import sys, importlib
for room in sys.argv.pop(1).split(","):
    if room:
        importlib.import_module(f"gz_course.grader.feedback.{room}").__path__.append(f"{sys.argv[1]}/{room}")
del sys.argv[1]
from gz_course.grader.course import main
main()
"""
NODE = """\
import rclpy
from rclpy.node import Node

rclpy.init()
node = Node("hello")
node.create_timer(0.1, lambda: [][0])
rclpy.spin(node)
"""


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    """Return a function that grades a node of the first exercise, with raising rules dropped into some rooms."""
    folder = tmp_path_factory.mktemp("broken")
    for room, (imports, given, body) in RULES.items():
        (folder / room).mkdir()
        (folder / room / "a_broken_file.py").write_text(f"{imports}\n\n\n@rule\ndef broken({given}):\n    {body}\n")
    (folder / "hello_node.py").write_text(NODE)

    def grade(rooms=""):
        out, report = folder / f"out_{rooms}", folder / f"{rooms or 'none'}.json"
        done = subprocess.run(
            [sys.executable, "-c", PROGRAM, rooms, folder, "grade", "00_first_run", "--out", out, "--json", report,
             "--submission", folder / "hello_node.py"],
            capture_output=True, text=True, timeout=300, env=os.environ | {"NO_COLOR": "1"}, check=False,
        )  # fmt: skip
        assert report.exists(), done.stdout + done.stderr
        return done, json.loads(report.read_text())

    return grade


def test_a_broken_rule_costs_nothing_and_is_named(graded):
    (whole, right), (done, broken) = graded(), graded(",".join(RULES))
    assert done.returncode == whole.returncode
    for key in ("score", "outcome", "checks"):
        assert right[key] == broken[key]
    assert right["diagnosis"] == broken["diagnosis"] and "died" in right["diagnosis"]
    assert right["notes"] == []
    for room, error in {"slips": "KeyError", "suspects": "RecursionError", "errors": "ValueError"}.items():
        (note,) = [each for each in broken["notes"] if f"rule {room}.a_broken_file.broken failed ({error}" in each]
        assert note.startswith("For the instructor: ") and "costs no points" in note
        assert " ".join(note.split()[:8]) in " ".join(done.stdout.split())
    assert "Traceback" not in done.stderr and "For the instructor" not in whole.stdout
