"""Facts about a run whose submission was a launch file: its arguments, and what it started.

`grader/kinds/launch/launch_run_loop.py` records the facts.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.launch_errors import launch_meaning

SAID = re.compile(r"^\[[^\]]+\] (gz sim|parameter_bridge|create|gzserver): (.*)")
STARTED = re.compile(r"^\[INFO\] \[[^\]]+-\d+\]: process started with pid")
OUTPUT = re.compile(r"^\[([^\] ]+-\d+)\] (.*\S)")  # a line of a process that the launch started
DIED = re.compile(r"^\[ERROR\] \[([^\]]+-\d+)\]: process has died .*exit code (-?\d+)")
ERROR = re.compile(r"^\[ERROR\] (?:\[[\d.]+\] )?\[[^\]]+\]: (.*)")  # of a ROS log
# A file that was given by a relative path and not found, as the bridge and Python say it (Python adds its folder).
NO_FILE = re.compile(r"(?:^|: |open file ')((?:/(?!submission)\w+/)?[\w.-]+\.\w+)'?: .*No such file or directory")
PLACE = re.compile(r"^\S*?([^/\s:]+):(\d+)(?::(\d+))?: ")  # prefix of an error in a launch file; XML has columns


@dataclass(frozen=True)
class Death:
    """A process of the launch that ended by itself with an exit code other than 0, and the last line it wrote."""

    process: str  # its name in the launch, without its number: that of the executed program
    code: int
    said: str

    @property
    def words(self) -> str:
        """Its output as the end of a sentence; empty if it printed nothing."""
        return f"; it said: {shown(self.said, 300)}" if self.said else ""


def launch_facts(recording: Recording) -> dict[str, Any]:
    """Return the facts about the launch; empty if the submission was none, or never ran."""
    found: dict[str, Any] = recording.facts().get("launch", {})
    return found


def argument(recording: Recording, name: str, default: str) -> tuple[str, str]:
    """Return the value of a launch argument in this run, and the command line of the launch."""
    trial = json.loads(recording.properties("run").get("trial_parameters", "{}"))
    given = {key: str(value) for key, value in trial.get("parameters", {}).items()}
    words = " ".join(f"{key}:={value}" for key, value in given.items())
    return given.get(name, default), f"called with {words}" if words else "called without arguments"


def by_python(recording: Recording, program: str) -> str:
    """Return that the launch file's Python has started a program instead of an action; empty if it has not."""
    if program not in launch_facts(recording).get("by_python", []):
        return ""
    return f"{program} was started by Python (subprocess or os.system), not by an action of the launch"


def ran(recording: Recording) -> list[dict[str, Any]]:
    """Return the simulators that ran."""
    return [each for each in launch_facts(recording).get("simulators", []) if each["ran"]]


def started(recording: Recording) -> bool:
    """Return whether the launch has started any process."""
    return any(STARTED.match(line.text) for line in recording.lines("log/student"))


def complaint(recording: Recording, program: str) -> str:
    """Return the first error or warning a program of Gazebo printed; empty if there is none."""
    for line in recording.lines("log/student"):
        if (match := SAID.match(line.text)) and match.group(1) == program:
            return shown(match.group(2), 300)
    return ""


def logged_error(recording: Recording, process: str) -> str:
    """Return the first error that a process of the launch has logged; empty if there is none."""
    for line in recording.lines("log/student"):
        output = OUTPUT.match(line.text)
        of_it = output is not None and output.group(1).rpartition("-")[0] == process
        if output and of_it and (error := ERROR.match(output.group(2))):
            return shown(error.group(1), 300)
    return ""


def deaths(recording: Recording) -> Iterator[Death]:
    """Yield the processes that died by themselves, in the order of their ends."""
    last: dict[str, str] = {}
    for line in recording.lines("log/student"):
        if match := DIED.match(line.text):
            if int(match.group(2)) > 0:
                yield Death(match.group(1).rpartition("-")[0], int(match.group(2)), last.get(match.group(1), ""))
        elif match := OUTPUT.match(line.text):
            last[match.group(1)] = match.group(2)


def looked_elsewhere(said: str) -> str:
    """Return why a file was not found, given what a program said of it; empty if it said nothing of that kind."""
    if not (match := NO_FILE.search(said)):
        return ""
    name = match.group(1).rpartition("/")[2]
    return (
        f"{name} was looked for in the folder in which ros2 launch was called, not beside the launch file: give its "
        f"full path, str(Path(__file__).parent / '{name}')"
    )


def _place_in_words(match: re.Match[str]) -> str:
    column = f", column {match[3]}" if match[3] else ""
    return f"{match[1]}, line {match[2]}{column}: "


def launch_fault(recording: Recording) -> str:
    """Return one sentence on why the launch as a whole failed; empty if it did not."""
    facts = launch_facts(recording)
    if error := facts.get("error", ""):
        said = "The launch failed: " + shown(PLACE.sub(_place_in_words, error), 400)
        why = launch_meaning(error)
        return f"{said}{'' if said.endswith(('.', '?')) else '.'} What that means: {why}." if why else said
    if facts and not facts["running"] and facts["exit_code"]:
        return f"The launch itself ended with exit code {facts['exit_code']}."
    return ""
