"""What robot_state_publisher says of a description that is none, and what that means."""

from __future__ import annotations

import re

from gz_course.grader.feedback.rules import guarded
from gz_course.grader.record.reading import Recording

REQUESTED = re.compile(r"^\[create-\d+\] .*Requesting creation of an entity")
PARTS = re.compile(r"Robot initialized: '.*', (\d+) joints move, (\d+) are fixed")
MANY = 1000  # joints: more than Gazebo simulates in any useful time
MEANINGS = (
    (
        re.compile(r"robot_description must be a text, not (-?\d+)"),
        "robot_description is the number {0}, such as os.system and subprocess.call return: the exit code of xacro, "
        "not what it prints; Command(['xacro ', path]) gives the text",
    ),
    (
        re.compile(r"<xacro:\w+> is for xacro, which was not run"),
        "robot_description is the text of the xacro file itself: xacro was not run over it; Command(['xacro ', path]) "
        "gives what xacro makes of it",
    ),
    (
        re.compile(r"syntax error: line 1, column 0"),
        "robot_description is no XML: perhaps the path of the file instead of its text; Command(['xacro ', path]) "
        "gives the text",
    ),
)


@guarded("")
def at_work_on(recording: Recording) -> str:
    """Return how large the robot is that create was asked for; empty if it was not asked, or it is not large."""
    lines = [line.text for line in recording.lines("log/student")]
    if not any(REQUESTED.match(line) for line in lines):
        return ""
    joints = next((sum(map(int, found.groups())) for line in lines if (found := PARTS.search(line))), 0)
    return f"the robot has {joints} joints, far too many to be simulated" if joints > MANY else ""


@guarded("")
def description_meaning(said: str) -> str:
    """Return what to change, given what robot_state_publisher said; empty if that is unknown."""
    for pattern, words in MEANINGS:
        if match := pattern.search(said):
            return words.format(*match.groups())
    return ""
