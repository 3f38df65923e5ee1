"""`kind = "node"`: what is known of a file before it runs goes into the facts of its run."""

from pathlib import Path

from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.trial import Trial
from gz_course.grader.kinds.node import plan
from gz_course.grader.kinds.programs import node_command
from gz_course.grader.submission.intake import take_in

NEUTRAL = {"origins", "conditions", "delays", "before_speeds", "of_the_drive", "rhythm"}


def suspicious(facts):
    """Return the facts without those that every file has, a right one too: where it makes what it sends, and when."""
    assert "origins" in facts
    return {name: places for name, places in facts.items() if name not in NEUTRAL}


def test_suspicious_places_of_the_file_become_facts(root, tmp_path):
    exercise = find_exercise("03_teleop", root)
    text = (root / "solutions" / "03_teleop" / exercise.file).read_text()
    node = tmp_path / exercise.file
    node.write_text(text)
    assert suspicious(plan(exercise, take_in(exercise, node)).facts) == {}
    node.write_text(f"import time\ntime.sleep(1)\ncommand.linear.x = 1\n{text}")
    assert suspicious(plan(exercise, take_in(exercise, node)).facts) == {
        "wall_clock": [{"file": exercise.file, "line": 2, "call": "time.sleep()", "waits": True}],
        "whole_numbers": [{"file": exercise.file, "line": 3, "field": "command.linear.x", "value": "1"}],
    }


def test_the_parameters_of_a_trial_are_those_of_the_node():
    """The words are read as `ros2 run PACKAGE NODE --ros-args -p NAME:=VALUE` reads them: values are YAML."""
    parameters = {"speed": 0.4, "side": "left", "count": 3, "word": "0.4", "loud": False, "names": ["a", "b"]}
    words = node_command(Path("node.py"), Trial("north", 0, parameters=parameters))
    assert words[words.index("--ros-args") + 1 :: 2] == ["-p"] * 7
    assert words[words.index("--ros-args") + 2 :: 2] == [
        "use_sim_time:=true", "speed:=0.4", 'side:="left"', "count:=3", 'word:="0.4"', "loud:=false",
        'names:=["a", "b"]',
    ]  # fmt: skip
