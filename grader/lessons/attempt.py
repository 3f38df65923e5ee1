"""One attempt at a step: the cell is executed, looked at, and answered in one sentence."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.grader.lessons.cell import execute, within
from gz_course.grader.lessons.running_world import RunningWorld
from gz_course.grader.lessons.step import NotYet, Step

if TYPE_CHECKING:
    from gz_course.grader.tools.playground import Playground


@dataclass(frozen=True)
class Answer:
    """What is said of an attempt: whether the step is done, what was seen, and what the cell broke."""

    done: bool
    seen: str
    notes: tuple[str, ...] = ()

    def __str__(self) -> str:
        mark = "\u2714 Done." if self.done else "\u2718 Not yet."
        return "\n".join([f"{mark} {self.seen}", *self.notes])


def attempt(
    step: Step, body: str, names: dict[str, Any], room: Playground, folder: Path, transform: Callable[[str], str]
) -> Answer:
    """Execute a cell and look at what it did. Whatever it raises, the answer says it.

    `names` is the notebook's namespace: a name of the playground that the cell took away is put back.
    """
    ours = {name: value for name, value in names.items() if value is room}
    directory = Path.cwd()
    running = [program for program in room.running if not program.stopped]
    try:
        output = execute(step, body, names, folder, transform)
        with within(step.limit):
            done, seen = True, step.check(RunningWorld(room, (step.name, body, output), names, folder))
    except NotYet as missing:
        done, seen = False, str(missing)
    except KeyboardInterrupt:
        done, seen = False, "The cell was interrupted."
    except Exception as error:  # of the check, not of the reader
        fault = f"{type(error).__name__}: {error}"
        done, seen = False, f"The check of this cell has a fault of its own ({fault}). Go on, and tell your instructor."
    notes = [
        f"The cell gave `{name}` another value; it is the playground again."
        for name in ours
        if names.get(name) is not room
    ]
    names.update(ours)
    if Path.cwd() != directory:
        os.chdir(directory)
        notes.append("The cell changed the folder; it is the chapter's again.")
    for program in running:
        if not program.stopped and (code := program.exit_code) is not None:
            how = f"was ended by {signal.Signals(-code).name}" if code < 0 else f"has ended (exit code {code})"
            notes.append(f"`{program.command}` {how}; run the cell that starts it again.")
    return Answer(done, seen, tuple(notes))
