"""Rooms of rules: a rule is a function under a room's decorator, found by looking into the room's folder.

A rule that raises costs no student anything: while `faults_kept` is open, `ask` writes down which rule failed, and what
the others find stands. Elsewhere, as in a test of the rule, the error is raised.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from functools import wraps
from types import ModuleType
from typing import Any, Generic, ParamSpec, TypeVar

from gz_course.grader.printable import shown
from gz_course.grader.registry import in_order, modules_below

FACT = "rule_faults"
HERE = __name__.rpartition(".")[0] + "."
Item = TypeVar("Item")
Answer = TypeVar("Answer")
Given = ParamSpec("Given")


class Room(Generic[Item]):
    """The rules in the files of a package and of the packages in it.

    A file whose rules are asked before those of other files names these, `BEFORE = ("names",)`. Otherwise files come in
    the order of their names. The rules of a file come in that of its lines.
    """

    def __init__(self, package: str) -> None:
        self.package = package
        self._rules: dict[str, list[Item]] = {}
        self._found: tuple[Item, ...] | None = None

    def add(self, item: Item, function: Callable[..., Any]) -> None:
        """Register a rule made of a function. Raises ValueError if the function is not in a file of the room."""
        if not function.__module__.startswith(f"{self.package}."):
            raise ValueError(f"{function.__module__}.{function.__name__} is a rule, but in no file of {self.package}")
        self._rules.setdefault(function.__module__, []).append(item)
        self._found = None

    def of(self, module: ModuleType) -> tuple[Item, ...]:
        """Return the rules of one file."""
        return tuple(self._rules.get(module.__name__, ()))

    def rules(self) -> tuple[Item, ...]:
        """Import the files of the room, and return their rules in the order in which they are asked.

        Raises ValueError if two files have one name, or if one stands before a file that does not exist.
        """
        if self._found is None:
            files: dict[str, ModuleType] = {}
            for module in modules_below(importlib.import_module(self.package)):
                name = module.__name__.rpartition(".")[2]
                if name in files:
                    raise ValueError(f"two files of {self.package} are called {name}")
                files[name] = module
            before = {name: getattr(module, "BEFORE", ()) for name, module in files.items()}
            self._found = tuple(rule for name in in_order(before) for rule in self.of(files[name]))
        return self._found


@dataclass(frozen=True)
class Fault:
    """A rule that raised: its name, as `slips.language.names.defined_twice`, and the error."""

    rule: str
    error: str

    def __str__(self) -> str:
        return (
            f"For the instructor: the feedback rule {self.rule} failed ({self.error}), which is a fault of the grader. "
            "It costs no points; at most, a hint is missing. Please report it to the authors of the course."
        )


_kept: ContextVar[list[Fault] | None] = ContextVar("faults", default=None)


@contextmanager
def faults_kept() -> Iterator[list[Fault]]:
    """Collect the rules that raise, instead of letting their errors pass."""
    found: list[Fault] = []
    before = _kept.set(found)
    try:
        yield found
    finally:
        _kept.reset(before)


def ask(rule: Callable[Given, Answer], otherwise: Answer, *given: Given.args, **named: Given.kwargs) -> Answer:
    """Return what a rule answers; `otherwise` if it raises. Nothing is wrong with it if memory is exhausted."""
    try:
        return rule(*given, **named)
    except MemoryError:
        raise
    except Exception as error:
        kept = _kept.get()
        if kept is None:
            raise
        name = f"{rule.__module__.removeprefix(HERE)}.{rule.__qualname__.partition('.')[0]}"
        fault = Fault(name, f"{type(error).__name__}: {error}"[:200])
        if fault not in kept:
            kept.append(fault)
        return otherwise


def as_facts(faults: Iterable[Fault]) -> dict[str, list[dict[str, str]]]:
    """Return faults as facts of a run; `recorded_faults` reads them."""
    rows = [{"rule": each.rule, "error": shown(each.error)} for each in faults]
    return {FACT: rows} if rows else {}


def recorded_faults(facts: Mapping[str, Any]) -> list[Fault]:
    """Return the rules that raised before a run, from its facts."""
    return [Fault(str(each["rule"]), str(each["error"])) for each in facts.get(FACT, [])]


def findings(rule: Callable[..., Iterable[Answer]], *given: Any) -> list[Answer]:
    """Return all that a rule finds; nothing if it raises."""

    @wraps(rule)
    def every() -> list[Answer]:
        return list(rule(*given))

    return ask(every, [])


def guarded(otherwise: Answer) -> Callable[[Callable[Given, Answer]], Callable[Given, Answer]]:
    """Let a rule that is called by its name answer `otherwise` where it raises."""

    def decorate(rule: Callable[Given, Answer]) -> Callable[Given, Answer]:
        @wraps(rule)
        def asked(*given: Given.args, **named: Given.kwargs) -> Answer:
            return ask(rule, otherwise, *given, **named)

        return asked

    return decorate
