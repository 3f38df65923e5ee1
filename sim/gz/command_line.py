"""The command line of a sub-command of `gz`: options, usage errors, signals and exit codes.

Wrong usage prints one line on stderr and returns the code of Gazebo's own tools: 104 an invalid value, 107 a missing
companion option, 108 options that exclude each other, 109 an unknown option, 114 a missing value.

Source: CLI11, `enum class ExitCodes`, https://github.com/CLIUtils/CLI11/blob/main/include/CLI/Error.hpp
"""

from __future__ import annotations

import argparse
import math
import os
import signal
import sys
import threading
from collections.abc import Sequence
from importlib import import_module
from types import FrameType
from typing import Any, NoReturn

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.postponed_signal import postponed

BAD_VALUE, NEEDS_OTHER, EXCLUDES_OTHER, UNKNOWN_OPTION, NO_VALUE = 104, 107, 108, 109, 114
_INTERRUPTED = 130
_MOST = 10**9
_SIGNALS = (signal.SIGINT, signal.SIGTERM)
_VALUE_MISSING = ("expected one argument", "expected at least one argument")


class Parser(argparse.ArgumentParser):
    """An option parser with required companion options and mutually exclusive ones."""

    def __init__(self, program: str, description: str) -> None:
        """Add `--help`, `--version` and `--versions`; `program` is what the user has typed, such as `gz topic`."""
        # "resolve": a sub-command may have another use for -v.
        super().__init__(prog=program, description=description, allow_abbrev=False, conflict_handler="resolve")
        self._needs: list[tuple[str, tuple[str, ...]]] = []
        self._excludes: list[tuple[str, ...]] = []
        self._commands: tuple[str, ...] = ()
        self.add_argument("-v", "--version", "--versions", action=Version, help="the version, and nothing else")

    def needs(self, option: str, *companions: str) -> None:
        """Require all companions (long names) whenever `option` is used."""
        self._needs.append((option, companions))

    def excludes(self, *options: str) -> None:
        """Declare options (long names) of which at most one may be used."""
        self._excludes.append(options)

    def commands(self, *options: str) -> None:
        """Declare options (long names) of which exactly one selects the action; without any, the help is printed."""
        self._commands = options
        self.excludes(*options)

    def read(self, arguments: Sequence[str]) -> argparse.Namespace:
        """Return the values of the options. Raises SystemExit after help, version and usage errors."""
        values, rest = self.parse_known_args(list(arguments))
        for group in self._excludes:
            found = [option for option in group if self._is_set(values, option)]
            if len(found) > 1:
                self._refuse(EXCLUDES_OTHER, f"{found[0]} excludes {found[1]}; use one of them.")
        for option, companions in self._needs:
            for companion in companions:
                if self._is_set(values, option) and not self._is_set(values, companion):
                    self._refuse(NEEDS_OTHER, f"{option} requires {companion}; see {self.prog} --help")
        if rest:
            self._refuse(UNKNOWN_OPTION, self._unknown(rest))
        if self._commands and not any(self._is_set(values, option) for option in self._commands):
            self.print_help()
            self.exit()
        return values

    def error(self, message: str) -> NoReturn:
        self._refuse(NO_VALUE if message.endswith(_VALUE_MISSING) else BAD_VALUE, message)

    def _is_set(self, values: argparse.Namespace, option: str) -> bool:
        action = self._option_string_actions[option]
        return getattr(values, action.dest) != action.default

    def _unknown(self, rest: list[str]) -> str:
        unknown = next((text for text in rest if text.startswith("-")), None)
        if unknown is None:
            return f"{rest[0]!r} belongs to no option; see {self.prog} --help"
        return unknown_option(unknown.partition("=")[0], list(self._option_string_actions), self.prog)

    def _refuse(self, code: int, sentence: str) -> NoReturn:
        print(f"{self.prog}: {sentence}", file=sys.stderr)
        raise SystemExit(code)


class Version(argparse.Action):
    """An option that prints the version of this distribution and exits."""

    def __init__(self, option_strings: Sequence[str], dest: str, help: str | None = None) -> None:
        super().__init__(option_strings, argparse.SUPPRESS, nargs=0, default=argparse.SUPPRESS, help=help)

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> NoReturn:
        from importlib import metadata

        print(metadata.version("gz-ros2-course"))
        parser.exit()


def positive_number(text: str) -> float:
    """Read a time [s] or a rate [Hz] of an option. Raises argparse.ArgumentTypeError below zero and above 1e9."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 <= value <= _MOST:
        raise argparse.ArgumentTypeError(f"expected a number, zero or more, at most 1e9, but found {text!r}")
    return value


def integer(text: str) -> int:
    """Read a whole number of an option. Raises argparse.ArgumentTypeError for anything else."""
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"expected a whole number, but found {text!r}") from None


def whole_number(text: str) -> int:
    """Read a count of an option. Raises argparse.ArgumentTypeError unless it is a whole number from 0 to 1e9."""
    if not (text.isascii() and text.isdigit() and int(text[:20]) <= _MOST):
        raise argparse.ArgumentTypeError(f"expected a whole number, zero or more, at most 1e9, but found {text!r}")
    return int(text)


def unknown_option(name: str, known: Sequence[str], program: str, kind: str = "option") -> str:
    """Return the sentence about an unknown option or command."""
    hint = did_you_mean(name, known, cutoff=0.5) or f"; see {program} --help"
    return f"there is no {kind} {name!r}{hint}"


def run(module_name: str, program: str, arguments: Sequence[str], description: str) -> int:
    """Import a sub-command and run it; return the exit code.

    The module has `add_arguments(parser)` and `run(values) -> int`. A ValueError or OSError from it is the user's
    error: its sentence is printed and the code is 1. SIGINT and SIGTERM arrive as KeyboardInterrupt, unless the module
    handles them itself. A closed output pipe ends the command silently.
    """
    before = [_handle(number, _interrupt) for number in _SIGNALS]
    try:
        if hasattr(sys.stdout, "reconfigure"):
            sys.stdout.reconfigure(line_buffering=True)
        module = import_module(module_name)
        parser = Parser(program, description)
        module.add_arguments(parser)
        code: int = module.run(parser.read(arguments))
        sys.stdout.flush()
        return code
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except (ValueError, OSError) as error:
        print(f"{program}: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return _INTERRUPTED
    finally:
        for number, handler in zip(_SIGNALS, before, strict=True):
            _handle(number, handler)


def leave_signals() -> None:
    """Ignore SIGINT and SIGTERM from now on, so that shutdown messages are sent without interruption."""
    for number in _SIGNALS:
        _handle(number, signal.SIG_IGN)


def _interrupt(number: int, frame: FrameType | None) -> None:
    if not postponed(number, frame):
        raise KeyboardInterrupt


def _handle(number: int, handler: Any) -> Any:
    """Set the handler of a signal where that is allowed; return the previous one."""
    if threading.current_thread() is threading.main_thread():
        return signal.signal(number, handler)
    return None
