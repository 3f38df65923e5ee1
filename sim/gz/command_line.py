"""The options of one sub-command of `gz`, and how it ends.

Between the dispatcher (`gz.command`) and a sub-command file `gz/*/commands/x.py`. Wrong usage is one line on
stderr and an exit code, those of Gazebo's own tools: 104 a value that cannot be read, 107 a missing companion,
108 options that exclude each other, 109 an option there is not, 114 a missing value.
"""

from __future__ import annotations

import argparse
import difflib
import os
import signal
import sys
import threading
from collections.abc import Sequence
from importlib import import_module
from typing import Any, NoReturn

BAD_VALUE, NEEDS_OTHER, EXCLUDES_OTHER, UNKNOWN_OPTION, NO_VALUE = 104, 107, 108, 109, 114
_INTERRUPTED = 130
_SIGNALS = (signal.SIGINT, signal.SIGTERM)
_VALUE_MISSING = ("expected one argument", "expected at least one argument")


class Parser(argparse.ArgumentParser):
    """Options with companions they need and options they exclude."""

    def __init__(self, program: str, description: str) -> None:
        """`program` is what the user has typed so far, e.g. `gz topic`."""
        super().__init__(prog=program, description=description, allow_abbrev=False)
        self._needs: list[tuple[str, tuple[str, ...]]] = []
        self._excludes: list[tuple[str, ...]] = []
        self._commands: tuple[str, ...] = ()
        self.add_argument("-v", "--version", action=_Version, help="the version, and nothing else")

    def needs(self, option: str, *companions: str) -> None:
        """From now on `option` is refused without all of its companions (long names)."""
        self._needs.append((option, companions))

    def excludes(self, *options: str) -> None:
        """From now on only one of these options (long names) may be given."""
        self._excludes.append(options)

    def commands(self, *options: str) -> None:
        """Exactly one of these options (long names) says what to do; without any of them help is printed."""
        self._commands = options
        self.excludes(*options)

    def read(self, arguments: Sequence[str]) -> argparse.Namespace:
        """The values of the options. SystemExit after help, after the version, and, explained, for wrong usage."""
        values, rest = self.parse_known_args(list(arguments))
        for group in self._excludes:
            given = [option for option in group if self._given(values, option)]
            if len(given) > 1:
                self._refuse(EXCLUDES_OTHER, f"{given[0]} excludes {given[1]}; use one of them.")
        for option, companions in self._needs:
            for companion in companions:
                if self._given(values, option) and not self._given(values, companion):
                    self._refuse(NEEDS_OTHER, f"{option} requires {companion}; see {self.prog} --help")
        if rest:
            self._refuse(UNKNOWN_OPTION, self._unknown(rest[0]))
        if not any(self._given(values, option) for option in self._commands):
            self.print_help()
            self.exit()
        return values

    def error(self, message: str) -> NoReturn:
        """What argparse found wrong, as one line."""
        self._refuse(NO_VALUE if message.endswith(_VALUE_MISSING) else BAD_VALUE, message)

    def _given(self, values: argparse.Namespace, option: str) -> bool:
        action = self._option_string_actions[option]
        return getattr(values, action.dest) != action.default

    def _unknown(self, text: str) -> str:
        if not text.startswith("-"):
            return f"{text!r} belongs to no option; see {self.prog} --help"
        name = text.partition("=")[0]
        nearest = difflib.get_close_matches(name, self._option_string_actions, n=1, cutoff=0.5)
        hint = f"did you mean {nearest[0]}?" if nearest else f"see {self.prog} --help"
        return f"there is no option {name!r}; {hint}"

    def _refuse(self, code: int, sentence: str) -> NoReturn:
        print(f"{self.prog}: {sentence}", file=sys.stderr)
        raise SystemExit(code)


class _Version(argparse.Action):
    """Prints the version of this distribution."""

    def __init__(self, option_strings: Sequence[str], dest: str, help: str | None = None) -> None:
        super().__init__(option_strings, argparse.SUPPRESS, nargs=0, default=argparse.SUPPRESS, help=help)

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> NoReturn:
        from importlib import metadata

        print(metadata.version("gz-ros2-course"))
        parser.exit()


def positive_seconds(text: str) -> float:
    """A time in seconds, for options; argparse.ArgumentTypeError when it is negative or no number."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 <= value < threading.TIMEOUT_MAX:
        raise argparse.ArgumentTypeError(f"expected seconds, zero or more, but found {text!r}")
    return value


def whole_number(text: str) -> int:
    """A number of things, zero or more, for options; argparse.ArgumentTypeError when it is none."""
    if not (text.isascii() and text.isdigit() and len(text) < 10):
        raise argparse.ArgumentTypeError(f"expected a whole number, zero or more, but found {text!r}")
    return int(text)


def nearest(name: str, known: Sequence[str]) -> str:
    """Half a sentence about the known name that is most like `name`, or an empty text."""
    found = difflib.get_close_matches(name, known, n=1, cutoff=0.6)
    return f"; did you mean {found[0]!r}?" if found else ""


def run(module_name: str, program: str, arguments: Sequence[str], description: str) -> int:
    """Imports a sub-command and runs it; the exit code.

    The module has `add_arguments(parser)` and `run(values) -> int`. Its ValueError and OSError are errors of the
    user: the sentence is printed and the code is 1. SIGINT and SIGTERM arrive in it as KeyboardInterrupt. When
    the reader of a pipe has gone the command ends quietly.
    """
    before = [_handle(number, signal.default_int_handler) for number in _SIGNALS]
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
    """From now on SIGINT and SIGTERM do nothing: saying goodbye to the network is not interrupted."""
    for number in _SIGNALS:
        _handle(number, signal.SIG_IGN)


def _handle(number: int, handler: Any) -> Any:
    """Sets the handler of a signal, where that is allowed; the one before it."""
    if threading.current_thread() is threading.main_thread():
        return signal.signal(number, handler)
    return None
