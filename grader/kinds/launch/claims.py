"""Which process may ask the grader for what: it must be the program of the course that would ask for it.

What a process is, the kernel says (`run/processes/peer.py`). A process that is something else is not served; what it
asked for is a fact of the recording.
"""

from __future__ import annotations

import argparse
import contextlib
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import PurePath
from typing import Any

from gz_course.grader.run.processes.participant import Participant
from gz_course.sim.gz.command_line import Parser
from gz_course.sim.gz.sim.commands import sim

SIMULATORS = ("gz", "gz_course.sim.gz.command")
BRIDGES = ("parameter_bridge", "gz_course.sim.bridge.ros_gz_bridge.parameter_bridge")
ENTITIES = "gz_course.sim.bridge.ros_gz_sim."  # modules that create, move and remove
# What a message asks for, by its first key; "stopped" is for both.
WORLD, BRIDGE, ENTITY = "a simulator", "a bridge", "an entity"
ASKS = {
    **dict.fromkeys(("world", "loading", "run", "control"), WORLD),
    "bridge": BRIDGE,
    **dict.fromkeys(("worlds", "call"), ENTITY),
}


@dataclass(frozen=True)
class SimulatorArguments:
    """What the command line of a `gz sim` says."""

    world: str
    paused: bool
    iterations: int


def is_entitled(who: Participant, message: dict[str, Any]) -> bool:
    """Whether a process is the program that asks for this; a message that asks for nothing is anybody's."""
    what = next((ASKS[key] for key in ASKS if key in message), "")
    program = who.peer.program[0]
    match what:
        case "a simulator":
            return simulator_arguments(who) is not None
        case "a bridge":
            return program in BRIDGES
        case "an entity":
            return program.startswith(ENTITIES)
    if "asset" in message:
        return program in SIMULATORS or program.startswith(ENTITIES)
    return True


def asked_for(message: dict[str, Any]) -> str:
    """Return in words what a message asks for; empty if for nothing."""
    return next((ASKS[key] for key in ASKS if key in message), "")


def simulator_arguments(who: Participant) -> SimulatorArguments | None:
    """Return what a `gz sim` was started with; None if it is none (any more)."""
    program, words = who.peer.program
    return _read(words[1:]) if program in SIMULATORS and words[:1] == ("sim",) else None


def _read(words: Sequence[str]) -> SimulatorArguments | None:
    parser = Parser("gz sim", "")
    sim.add_arguments(parser)
    said = io.StringIO()
    try:
        with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
            values = parser.read(words)
    except (SystemExit, argparse.ArgumentError):
        return None
    return SimulatorArguments(str(values.file), not values.run, int(values.iterations))


def names(given: str, built_in: str) -> bool:
    """Whether a word on a command line can be the name of a built-in world, with or without its suffix."""
    return PurePath(given).name in (built_in, PurePath(built_in).stem)
