"""The settings of ExecuteLocal, checked when it is created and performed when it is executed."""

from __future__ import annotations

import logging
import math
import signal
from dataclasses import dataclass
from typing import Any

from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.process_output import sinks
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions import LaunchConfiguration
from gz_course.sim.ros.launch.substitutions.find_executable import nearest_program
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

_DEFAULT_TIMEOUT = 5  # [s]


@dataclass(frozen=True)
class ProcessSettings:
    """The performed settings; `timeouts` [s] are those after SIGINT and after SIGTERM, `respawn_delay` is in [s]."""

    output: Any
    emulate_tty: bool
    respawn: bool
    respawn_delay: float
    respawn_max_retries: int
    timeouts: dict[signal.Signals, float]
    logger: logging.Logger


def timeout_substitutions(name: str, value: Any) -> list[Substitution]:
    """Return a time-out [s] as substitutions; None means the launch configuration `name`, with default 5."""
    if value is None:
        return [LaunchConfiguration(name, default=_DEFAULT_TIMEOUT)]
    return plain_or_substitutions(value)


def plain_or_substitutions(value: Any) -> list[Substitution]:
    """Return a bool, a number or substitutions as a list of substitutions."""
    return normalize_to_list_of_substitutions(str(value) if isinstance(value, bool | int | float) else value)


def whole_number(context: LaunchContext, parts: list[Substitution]) -> int:
    """Return the performed number of restarts. Raises LaunchError if it is none."""
    text = perform_substitutions(context, parts)
    try:
        return int(text)
    except ValueError:
        raise LaunchError(f"respawn_max_retries is {text!r}, not a whole number") from None


def seconds(context: LaunchContext, parts: list[Substitution]) -> float:
    """Return the performed time-out or delay [s]. Raises LaunchError if it is no number of seconds."""
    text = perform_substitutions(context, parts)
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 <= value < math.inf:
        raise LaunchError(f"the time {text!r} is no number of seconds")
    return value


def normalized_output(output: Any) -> Any:
    """Return an `output=`, checked if it is plain text, else as substitutions. Raises LaunchError."""
    if isinstance(output, str | dict):
        sinks(output)
        return output
    return normalize_to_list_of_substitutions(output)


def performed_output(output: Any, context: LaunchContext) -> Any:
    """Return an `output=` as a word or a dict."""
    return perform_substitutions(context, output) if isinstance(output, list) else output


def why_not_started(error: Exception, command: list[str], cwd: str | None, context: LaunchContext) -> str:
    """Return why a process did not start, in one sentence."""
    program = command[0]
    if isinstance(error, FileNotFoundError) and cwd is not None and error.filename == cwd:
        return f"'{program}' cannot be started in the folder '{cwd}', which does not exist"
    if isinstance(error, NotADirectoryError) and cwd is not None:
        return f"'{program}' cannot be started in '{cwd}', which is no folder"
    if isinstance(error, FileNotFoundError | NotADirectoryError):
        return f"there is no program '{program}' to be started{nearest_program(program, context)}"
    if isinstance(error, PermissionError):
        return f"'{program}' cannot be started: it is not executable (chmod +x makes it so)"
    if isinstance(error, OSError) and error.errno == 8:
        return f"'{program}' cannot be started: its first line must be #! and an interpreter"
    return f"'{program}' cannot be started: {getattr(error, 'strerror', None) or error}"
