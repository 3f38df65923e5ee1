"""Finds processes of a launch test by action, name or arguments."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from gz_course.sim.ros.launch.actions.execute_local import ExecuteLocal

Target = ExecuteLocal | str | None

NO_CMD_ARGS = object()


class NoMatchingProcessException(Exception):
    """No process of the test has this name."""


def resolveProcesses(
    info_obj: Any, *, process: Target = None, cmd_args: Any = None, strict_proc_matching: bool = True
) -> list[ExecuteLocal]:
    """Return the processes of `info_obj` that match: an action, those whose names contain a text, or all (None).

    `cmd_args` are arguments of the command that a process found by name must have; NO_CMD_ARGS stands for a command
    without arguments. Raises NoMatchingProcessException if there is none, and an Exception if a name fits several and
    `strict_proc_matching` is True.
    """
    known = list(info_obj.processes())
    if process is None:
        if not known:
            raise NoMatchingProcessException("No data recorded for any process")
        return known
    if isinstance(process, ExecuteLocal):
        if process not in known:
            raise NoMatchingProcessException(f"No data recorded for proc {_words(process)}")
        return [process]
    if not isinstance(process, str):
        raise TypeError(f"proc argument must be 'ExecuteProcess' or 'str' not {type(process)}")
    arguments = [cmd_args] if isinstance(cmd_args, str) else cmd_args
    found = [each for each in known if process in each.process_details["name"] and _has_arguments(each, arguments)]
    if found and (len(found) == 1 or not strict_proc_matching):
        return found
    names = ", ".join(sorted(_words(each) for each in known))
    if not found:
        raise NoMatchingProcessException(
            f"Did not find any processes matching name '{process}' and args '{arguments}'. Procs: {names}"
        )
    raise Exception(f"Found multiple processes matching name '{process}' and cmd_args '{arguments}'. Procs: {names}")


def _has_arguments(action: Any, wanted: Iterable[str] | object | None) -> bool:
    arguments = action.process_details["cmd"][1:]
    if wanted is NO_CMD_ARGS:
        return not arguments
    return wanted is None or all(each in arguments for each in wanted)  # type: ignore[attr-defined]


def _words(action: Any) -> str:
    """Return the name and the arguments of a process, or its description before its start."""
    details = action.process_details
    return " ".join([details["name"], *details["cmd"][1:]]) if details else action.describe()
