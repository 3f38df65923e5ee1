"""The substitution for the output of a command."""

from __future__ import annotations

import os
import re
import shlex
import signal
import subprocess

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions.find_executable import nearest_program
from gz_course.sim.ros.launch.substitutions.substitution_failure import SubstitutionFailure
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

_ON_STDERR = ("fail", "ignore", "warn", "capture")
_NO_REASON = re.compile(r"(?mi)^((?:\w*error):)[ \t]*$")
_TRACE = ("Traceback (most recent", "During handling of the above", "The above exception was")


class Command(Substitution):
    """The output of `command`, which is split into words like in a shell and started without one.

    `on_stderr` selects what output on stderr does: `fail` (the default), `ignore`, `warn`, or `capture`, with which it
    stands in the result where it was written. A failing command always raises SubstitutionFailure.
    """

    def __init__(self, command: SomeSubstitutionsType, *, on_stderr: SomeSubstitutionsType = "fail") -> None:
        self.command = normalize_to_list_of_substitutions(command)
        self.on_stderr = normalize_to_list_of_substitutions(on_stderr)

    def describe(self) -> str:
        return f"Command({describe_substitutions(self.command)})"

    def perform(self, context: LaunchContext) -> str:
        """Run the command until its end; return its stdout including the last newline."""
        text = perform_substitutions(context, self.command)
        on_stderr = perform_substitutions(context, self.on_stderr)
        if on_stderr not in _ON_STDERR:
            raise SubstitutionFailure(f"on_stderr of Command is {on_stderr!r}; it can be {', '.join(_ON_STDERR)}")
        try:
            words = shlex.split(text)
        except ValueError as error:
            raise SubstitutionFailure(f"the command {text!r} cannot be split into words: {error}") from None
        if not words:
            raise SubstitutionFailure("the command of Command is empty")
        code, output, errors = _run(words, context, one_stream=on_stderr == "capture")
        if code != 0:
            ended = f"exit code {code}" if code > 0 else f"signal {signal.Signals(-code).name}"
            printed = output if on_stderr == "capture" else errors
            said = f": {_without_traces(printed)}" if printed.strip() else ""
            raise SubstitutionFailure(f"the command '{text}' failed with {ended}{said}")
        if errors and on_stderr == "fail":
            raise SubstitutionFailure(
                f"the command '{text}' wrote to stderr, which on_stderr='warn' would allow: {errors.strip()}"
            )
        if errors and on_stderr == "warn":
            launch_logging.get_logger("launch.substitutions.command").warning(
                f"the command '{text}' wrote to stderr: {errors.strip()}"
            )
        return output


def _without_traces(errors: str) -> str:
    """Return the text without tracebacks, whose lines are not in the launch file; `error:` alone gets a reason."""
    errors = _NO_REASON.sub(r"\1 it gives no reason, as a program does that runs out of memory", errors)
    if _TRACE[0] not in errors:
        return errors.strip()
    return "; ".join(line for line in errors.splitlines() if line and not line.startswith((" ", *_TRACE)))


def _run(words: list[str], context: LaunchContext, *, one_stream: bool) -> tuple[int, str, str]:
    """Return exit code, stdout and stderr of a command; with `one_stream` stdout holds both.

    An interruption of this function kills the command.
    """
    process = None
    try:
        with context.uninterrupted():
            process = subprocess.Popen(
                words,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT if one_stream else subprocess.PIPE,
                env=dict(context.environment),
                process_group=0,
            )
        output, errors = process.communicate()
    except FileNotFoundError:
        known = nearest_program(words[0], context)
        raise SubstitutionFailure(f"there is no program '{words[0]}' for Command to run{known}") from None
    except OSError as error:
        raise SubstitutionFailure(f"the program '{words[0]}' does not start: {error.strerror}") from None
    finally:
        if process is not None:
            with context.uninterrupted():
                if process.poll() is None:
                    os.killpg(process.pid, signal.SIGKILL)
                with process:  # closes the pipes and reaps the process
                    pass
    return process.returncode, output.decode(errors="replace"), (errors or b"").decode(errors="replace")
