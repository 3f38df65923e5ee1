"""`kind = "bridge"`: the submission is the YAML file of a ros_gz_bridge.

Its entries connect the simulator with the exercise's own node (`given_node.py`), which commands the robots and listens
to their sensors. What `lint` reports about the file is recorded as a fact. Errors that the original ros_gz_bridge
ignores are ignored here too; a file from which no bridge can be made is the student's error.
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING

from gz_course.grader.kinds.exercise_node import diagnosis, run_loop
from gz_course.grader.kinds.given_node import EXERCISE_NODE, exercise_node
from gz_course.grader.kinds.kind import Kind, RunPlan
from gz_course.grader.kinds.programs import node_command
from gz_course.grader.printable import shown

if TYPE_CHECKING:
    from gz_course.grader.exercise import Exercise
    from gz_course.grader.submission import Submission
    from gz_course.sim.bridge.ros_gz_bridge.config import Config
    from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry
    from gz_course.sim.bridge.ros_gz_bridge.finding import Finding

NODE = "ros_gz_bridge"  # name of the bridge's node; `~` in a ROS name stands for it
MOST_BRIDGES = 100
KEY = re.compile(r"[\w/~.-]+:")


def read(name: str, content: bytes) -> Config:
    """Read the entries of the file, including faulty ones."""
    from gz_course.sim.bridge.ros_gz_bridge.checks import private_gz_names, volatile_static_transforms
    from gz_course.sim.bridge.ros_gz_bridge.config import read_yaml

    config = read_yaml(content, name)
    config.findings += private_gz_names(config.topics, config.services)
    config.findings += volatile_static_transforms(config.topics)
    return config


def fault(name: str, content: bytes) -> str | None:
    """Return why no bridge can be made from a file, with the line, or None."""
    config = read(name, content)
    if len(config.topics) > MOST_BRIDGES:
        return f"{name}: {len(config.topics)} bridges; at most {MOST_BRIDGES} are run here"
    errors = sorted(filter(lambda finding: not finding.warning, config.findings), key=_follows)
    return shown(f"{errors[0]}{_below(content, str(errors[0]))}") if errors and not usable(config) else None


def _follows(finding: Finding) -> bool:
    """Whether a finding is likely to follow from another one: a key is missing because it is misspelt."""
    return finding.sentence.endswith("both ros_type_name and gz_type_name")


def _below(content: bytes, error: str) -> str:
    """Return the end of a sentence on what stands above the bridges in a file that is no list; else nothing."""
    if "found a mapping" not in error:
        return ""
    if b"ros__parameters" in content:
        return "; this is no file of ROS parameters, so there is no ros__parameters in it"
    first = next((line for line in content.decode("utf-8", "replace").splitlines() if KEY.match(line)), "")
    return f"; here, all stands below keys such as {first.partition(':')[0].strip()!r}" if first else ""


def usable(config: Config) -> list[BridgeEntry]:
    """Return the entries that the original ros_gz_bridge would bridge, with their names as they are in both graphs.

    A graded run has subscribers from beginning to end, so a lazy entry is always connected.
    """
    return [
        replace(entry, ros_topic=_ros_name(entry.ros_topic), gz_topic=f"/{entry.gz_topic.strip('/')}", lazy=False)
        for entry in config.tolerant().topics
        if not entry.gz_topic.startswith("~")
    ]


def _ros_name(name: str) -> str:
    """Return a ROS name resolved for the bridge's node, which has no namespace."""
    for what, becomes in (("{node}", NODE), ("{namespace}", ""), ("{ns}", ""), ("~", f"/{NODE}")):
        name = name.replace(what, becomes)
    return f"/{name.lstrip('/')}"


def plan(exercise: Exercise, submission: Submission) -> RunPlan:
    """Run the exercise's own node beside the submission's bridges; record what lint reports about them as a fact."""
    config = read(submission.main, submission.files[submission.main])
    found = [
        {
            "place": finding.place,
            "sentence": shown(finding.sentence),
            "warning": finding.warning,
            "advice": finding.advice,
        }
        for finding in config.findings
    ]
    lazy = [_ros_name(entry.ros_topic) for entry in config.tolerant().topics if entry.lazy]
    return RunPlan(EXERCISE_NODE, exercise_node(exercise), usable(config), lambda: {"lint": found, "lazy": lazy})


KIND = Kind((".yaml", ".yml"), fault, plan, node_command, run_loop, diagnosis, brings_bridge=True)
