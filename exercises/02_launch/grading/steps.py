"""The cells that the reader of chapter 2 writes."""

from __future__ import annotations

import re

from gz_course.grader.lessons.step import NotYet, Tried, expect, step

STARTED = "process started"
SAID = re.compile(r"it is (\d+\.\d) s")
LONG = 120.0  # [s] that a launch and what is asked of it may take
EPOCH = 1e6  # [s]; a clock that shows more counts from 1970
MODEL = re.compile(r"^\s+- (\S+)$", re.MULTILINE)


def launched(tried: Tried, arguments: str, ready: str = STARTED) -> str:
    """Start a launch file, after whatever launch there was; return what it printed."""
    tried.stop("ros2 launch")
    return tried.start(f"ros2 launch {arguments}", ready=ready)


def is_paused(tried: Tried) -> bool:
    """Ask the simulator whether its time stands still."""
    try:
        return "paused: true" in tried.command("gz topic -e -t /stats -n 1", deadline=15.0)
    except NotYet:
        raise NotYet("No simulator runs: nothing came on /stats.") from None


def models(tried: Tried) -> set[str]:
    """Ask the simulator for the models of its world."""
    return set(MODEL.findall(tried.command("gz model --list")))


@step("running", objective=1, form="running.launch.py", limit=LONG)
def running(tried: Tried) -> str:
    """The launch file starts the room, and time runs."""
    launched(tried, "running.launch.py")
    expect(not is_paused(tried), "The simulator runs, and its world is paused; time should run.")
    there = models(tried)
    tried.stop("ros2 launch")
    expect("pillar" in there, f"The world has the models {', '.join(sorted(there))}; lidar_room.sdf has others.")
    return "The room is simulated, and its time runs."


@step("crier", objective=4, form="crier.launch.py", limit=LONG)
def crier(tried: Tried) -> str:
    """The town crier says simulated time."""
    printed = launched(tried, "crier.launch.py", ready="it is ")
    found = SAID.search(printed + tried.stop("ros2 launch"))
    if found is None:
        raise NotYet("The town crier said no time.")
    seconds = float(found[1])
    expect(seconds < EPOCH, f"The town crier says {seconds:z.1f} s: seconds since 1970, and not simulated time.")
    return f"The town crier says {seconds:z.1f} s: simulated time."


@step("passed_on", objective=2, form="passed_on.launch.py", limit=LONG)
def passed_on(tried: Tried) -> str:
    """The pendulum runs without a window, started by the included file."""
    launched(tried, "passed_on.launch.py")
    paused, there = is_paused(tried), models(tried)
    tried.stop("ros2 launch")
    expect("pendulum" in " ".join(there), f"The world has the models {', '.join(sorted(there))}, and no pendulum.")
    expect(not paused, "The pendulum is there, and its world is paused; time should run.")
    return "The included file runs the pendulum."


@step("pausing", objective=3, form="pausing.launch.py", limit=LONG)
def pausing(tried: Tried) -> str:
    """The argument paused decides whether time runs."""
    for value in ("true", "false"):
        launched(tried, f"pausing.launch.py paused:={value}")
        paused = is_paused(tried)
        said = f"With paused:={value} the world {'is paused' if paused else 'runs'}"
        expect(paused == (value == "true"), f"{said}; it should be the other way.")
    tried.stop("ros2 launch")
    return "paused:=true gives a paused world, and paused:=false one that runs."
