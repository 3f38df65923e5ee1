"""Facts about a run whose submission was a launch file: its arguments, and what it started.

`grader/kinds/launch/launch_run_loop.py` records the facts.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from gz_course.grader.feedback.errors.launch_errors import launch_meaning
from gz_course.grader.feedback.errors.python_errors import meaning
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.crash import Crash, read_crash

if TYPE_CHECKING:
    from gz_course.grader.score.check import Finding

SAID = re.compile(r"^\[[^\]]+\] (gz sim|parameter_bridge|create|gzserver): (.*)")
STARTED = re.compile(r"^\[INFO\] \[[^\]]+-\d+\]: process started with pid")
OUTPUT = re.compile(r"^\[([^\] ]+-\d+)\] (.*\S)")  # a line of a process that the launch started
DIED = re.compile(r"^\[ERROR\] \[([^\]]+-\d+)\]: process has died .*exit code (-?\d+)")
ERROR = re.compile(r"^\[ERROR\] (?:\[[\d.]+\] )?\[[^\]]+\]: (.*)")  # of a ROS log
# A file that was given by a relative path and not found, as the bridge and Python say it (Python adds its folder).
NO_FILE = re.compile(r"(?:^|: |open file ')((?:/(?!submission)\w+/)?[\w.-]+\.\w+)'?: .*No such file or directory")
OTHER_FOLDER = re.compile(r"(?:^|: |open file ')(/(?:[\w.-]+/)*)([\w.-]+\.\w+)'?: .*No such file or directory")
OF_A_FILE = re.compile(r"([\w.-]+\.py)/[\w./-]+'?: .*Not a directory")
NOT_STARTED = re.compile(r"^\[ERROR\] \[[^\]]+-\d+\]: (.*(?:there is no program '|cannot be started).*)")
GLUED = re.compile(r"argument (-\w): ignored explicit argument '([^']+)'")
NO_WORLD = re.compile(r"^world file '([^']+)' was not found")
PLACE = re.compile(r"^\S*?([^/\s:]+):(\d+)(?::(\d+))?: ")  # prefix of an error in a launch file; XML has columns


@dataclass(frozen=True)
class Death:
    """A process of the launch that ended by itself with an exit code other than 0, and why.

    `said` is the error its traceback ends in, else the last line it wrote.
    """

    process: str  # its name in the launch, without its number: that of the executed program
    code: int
    said: str
    crash: Crash | None = None

    @property
    def words(self) -> str:
        """Its output as the end of a sentence; empty if it printed nothing."""
        place = f" ({self.crash.place})" if self.crash and self.crash.place else ""
        return f"; it said: {shown(self.said, 300)}{place}" if self.said else ""

    @property
    def why(self) -> str:
        """What to change, and where; empty if the error is unknown."""
        known = self.crash.meaning if self.crash else meaning(self.said)
        why = looked_elsewhere(self.said) or known or launch_meaning(self.said)
        return f"{self.crash.place}: {why}" if why and self.crash and self.crash.place else why


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


def own_end(recording: Recording, program: str) -> str:
    """Return which line of a program of the submission has ended it, without an error; empty if none is known."""
    places = [each for each in recording.facts().get("own_ends", []) if each["file"] == program]
    return shown(f"{program}, line {places[0]['line']}: {places[0]['said']}", 300) if places else ""


def without_sim_time(recording: Recording, program: str) -> str:
    """Return which action starts the program without use_sim_time, and which has it instead; empty if unknown."""
    for place in recording.facts().get("programs", []):
        if place["program"] != program or place["sim_time"]:
            continue
        other = place["executable"] or "another program"
        given = f"; line {place['elsewhere']} gives it to {other}" if place["elsewhere"] else ""
        return f"{place['file']}, line {place['line']}: the command of {program} does not hold use_sim_time{given}"
    return ""


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
    output: dict[str, list[str]] = {}
    for line in recording.lines("log/student"):
        if match := DIED.match(line.text):
            if int(match.group(2)) > 0:
                lines = output.get(match.group(1), [])
                crash = read_crash(lines)
                said = crash.error if crash else _last_words(lines)
                yield Death(match.group(1).rpartition("-")[0], int(match.group(2)), said, crash)
        elif match := OUTPUT.match(line.text):
            output.setdefault(match.group(1), []).append(match.group(2))


def _last_words(lines: list[str]) -> str:
    """Return the last line of an output; the error before the usage of a command, if it ends with that."""
    usage = next((number for number, line in enumerate(lines) if line.startswith("usage:")), 0)
    if usage and "error" in lines[usage - 1].lower():
        return lines[usage - 1]
    return lines[-1] if lines else ""


def not_started(recording: Recording, findings: Iterable[Finding] = ()) -> str:
    """Return one sentence about the first program that could not be started; empty if all could."""
    for line in recording.lines("log/student"):
        if match := NOT_STARTED.match(line.text):
            said = PLACE.sub(_place_in_words, match.group(1))
            why = launch_meaning(said)
            return shown(f"{said}. What that means: {why}." if why else f"{said}.", 500)
    return ""


def launch_slips(recording: Recording, findings: Iterable[Finding] = ()) -> str:
    """Return one sentence about a mistake in the launch file that raises no error of its own; empty if none is."""
    for place in recording.facts().get("launch_slips", []):
        return shown(f"{place['file']}, line {place['line']}: {place['said']}.", 500)
    return ""


def simulator_fault(said: str, recording: Recording) -> str:
    """Return what is wrong with the command line of a `gz sim`, given what it said; empty if that is unknown."""
    if (match := GLUED.search(said)) and match[2].startswith(" "):
        return f"{match[1]}{match[2]} is one word, with spaces in it: each word of a command is an item of its own"
    if match:
        return (
            f"a space is missing between {match[1]} and {match[2]}: what is joined to one text, as the parts of "
            "gz_args are, is joined without spaces"
        )
    if not (match := NO_WORLD.search(said)):
        return ""
    given = match[1]
    folder, _, name = given.rpartition("/")
    names = {place["name"] for place in recording.facts().get("declared", [])}
    if " object at 0x" in given:
        return "the description of a Python object stands in the command, not the value of a launch configuration"
    if match := re.search(r"\$\((?:var|arg) (\w+)\)", given):
        return (
            f"'{match[0]}' is a text in a launch file in Python; XML and YAML write it so, and Python writes "
            f"LaunchConfiguration('{match[1]}')"
        )
    if match := re.search(r"\{(\w+)[^}]*\}", given):
        return (
            f"'{match[0]}' is a text, with its braces: the LaunchConfiguration itself, not in quotes, is the item of "
            "the list, and gets its value when the launch runs"
        )
    if given in names:
        return f"'{given}' is a text; the value of the argument is LaunchConfiguration('{given}')"
    trial = json.loads(recording.properties("run").get("trial_parameters", "{}"))
    asked = str(trial.get("parameters", {}).get("world", ""))
    defaults = {place.get("default", "") for place in recording.facts().get("declared", []) if place["name"] == "world"}
    if not folder and given in {place for place in defaults if "/" not in place}:
        return (
            f"{name} has no folder, so it is looked for in the folder in which ros2 launch was called, and among the "
            f"built-in worlds; one beside the launch file is str(Path(__file__).parent / '{name}')"
        )
    if folder and (name == asked or f" {name}" in said or not asked):
        return (
            f"{name} is looked for in the folder {folder}, and it is not there: the worlds of the course are built in, "
            "and are named without a folder"
        )
    return ""


def several_simulators(recording: Recording) -> str:
    """Return which action starts a simulator that no condition keeps back; empty if that is unknown."""
    made = recording.facts().get("simulators_made", [])
    free = [each for each in made if not each["condition"]]
    bound = [each for each in made if each["condition"]]
    if len(made) < 2:
        return ""
    if free and bound:
        return (
            f"{free[0]['file']}, line {free[0]['line']}: this simulator has no condition, so it starts in any case, "
            f"beside that of line {bound[0]['line']}, which has condition={bound[0]['condition']}: it needs the "
            "opposite condition"
        )
    if free:
        return (
            f"{free[0]['file']}, line {free[1]['line']}: a second simulator is started here, beside that of line "
            f"{free[0]['line']}, and no condition keeps either back: IfCondition and UnlessCondition let one start"
        )
    if len({each["condition"] for each in bound}) == 1:
        return (
            f"{bound[0]['file']}, line {bound[1]['line']}: this simulator has the same condition as that of line "
            f"{bound[0]['line']}, {bound[0]['condition']}, so both start: it needs the opposite one"
        )
    return ""


def kept_back(recording: Recording, kind: str) -> str:
    """Return the condition that keeps all actions of a kind (`simulators_made`, `bridges_made`) back, or nothing."""
    made = recording.facts().get(kind, [])
    if not made or not all(each["condition"] for each in made):
        return ""
    what, other = made[0], "; nothing else starts one"
    if len(made) > 1:
        other = f", and that of line {made[1]['line']} only with condition={made[1]['condition']}"
    return (
        f"{what['file']}, line {what['line']}: this starts only with condition={what['condition']}{other}, so that "
        "here nothing did"
    )


def declared(recording: Recording, name: str, default: str) -> str:
    """Return that the launch file declares no argument of this name, or one with another default; else nothing."""
    places = recording.facts().get("declared", [])
    names = [place["name"] for place in places]
    mine: dict[str, Any] = next((place for place in places if place["name"] == name), {})
    given, _ = argument(recording, name, "")
    if mine.get("default", "") and not given and mine["default"].lower() != default.lower():
        return (
            f"{mine['file']}, line {mine['line']}: the default_value of {name} is '{mine['default']}', not '{default}'"
        )
    if not names or name in names or "" in names:
        return ""
    others = ", ".join(each for each in names)
    return f"the launch file declares no argument called {name}; it declares {shown(others, 100)}"


def looked_elsewhere(said: str) -> str:
    """Return why a file was not found, given what a program said of it; empty if it said nothing of that kind."""
    if match := OF_A_FILE.search(said):
        return f"{match[1]} is the launch file itself, not a folder: its folder is Path(__file__).parent"
    if not (match := NO_FILE.search(said)):
        match = OTHER_FOLDER.search(said)
        return (
            f"{match[2]} was looked for in the folder {match[1]}, where it does not lie; the folder of the launch "
            "file is Path(__file__).parent"
            if match
            else ""
        )
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
        if why:
            said += f"{'' if said.endswith(('.', '?')) else '.'} What that means: {why}."
        slip = launch_slips(recording)
        return f"{said}{'' if said.endswith(('.', '?')) else '.'} {slip}" if slip else said
    if facts and not facts["running"] and facts["exit_code"]:
        return f"The launch itself ended with exit code {facts['exit_code']}."
    return ""
