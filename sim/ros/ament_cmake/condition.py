"""The condition of an `if()` in a CMakeLists.txt.

Source: if, https://cmake.org/cmake/help/latest/command/if.html
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping
from pathlib import Path

from gz_course.sim.ros.ament_cmake.cmake_text import Argument, values_of

_TRUE = {"1", "ON", "YES", "TRUE", "Y"}
_FALSE = {"", "0", "OFF", "NO", "FALSE", "N", "IGNORE", "NOTFOUND"}


class UnknownConditionError(Exception):
    """A condition that is not understood; its text is the word that was not."""


def holds(arguments: tuple[Argument, ...], variables: Mapping[str, str], lookup: Callable[[str, str], str]) -> bool:
    """Whether a condition holds. Raises UnknownConditionError."""
    words = []
    for argument in arguments:
        quoted = argument.kind != "unquoted"
        words += [(value, quoted) for value in values_of((argument,), lookup)]
    condition = _Condition(words, variables)
    result = condition.either()
    if condition.words:
        raise UnknownConditionError(condition.words[0][0])
    return result


class _Condition:
    """What is left of a condition, taken from the left; `words` are values, and whether each was quoted."""

    def __init__(self, words: list[tuple[str, bool]], variables: Mapping[str, str]) -> None:
        self.words = words
        self._variables = variables

    def either(self) -> bool:
        result = self._both()
        while self._next("OR"):
            result = self._both() or result
        return result

    def _both(self) -> bool:
        result = self._negated()
        while self._next("AND"):
            result = self._negated() and result
        return result

    def _negated(self) -> bool:
        if self._next("NOT"):
            return not self._negated()
        if self._next("("):
            result = self.either()
            if not self._next(")"):
                raise UnknownConditionError("(")
            return result
        if self._next("DEFINED"):
            name = self._take()[0]
            env = re.fullmatch(r"ENV\{(.*)\}", name)
            return env[1] in os.environ if env else name in self._variables
        if self._next("EXISTS"):
            return Path(self._take()[0]).exists()
        return self._compared(self._take())

    def _compared(self, left: tuple[str, bool]) -> bool:
        operator = self.words[0] if self.words else ("", True)
        compare = None if operator[1] else _COMPARISONS.get(operator[0])
        if compare is None:
            return self._true(left)
        self.words.pop(0)
        right = self._take()
        seen = right[0] if operator[0] == "MATCHES" else self._value(right)
        try:
            return compare(self._value(left), seen)
        except (ValueError, re.error):
            raise UnknownConditionError(right[0]) from None

    def _true(self, word: tuple[str, bool]) -> bool:
        text, quoted = word
        if text.upper() in _TRUE or re.fullmatch(r"-?\d*[1-9]\d*", text):
            return True
        if text.upper() in _FALSE or text.upper().endswith("-NOTFOUND") or quoted:
            return False
        value = self._variables.get(text, "").upper()
        return value not in _FALSE and not value.endswith("-NOTFOUND")

    def _value(self, word: tuple[str, bool]) -> str:
        return word[0] if word[1] else self._variables.get(word[0], word[0])

    def _next(self, word: str) -> bool:
        if self.words and self.words[0] == (word, False):
            self.words.pop(0)
            return True
        return False

    def _take(self) -> tuple[str, bool]:
        if not self.words:
            raise UnknownConditionError("its end")
        return self.words.pop(0)


def _version(text: str) -> list[int]:
    numbers = [int(part) for part in re.findall(r"\d+", text)]
    while numbers and numbers[-1] == 0:
        numbers.pop()
    return numbers


_COMPARISONS: dict[str, Callable[[str, str], bool]] = {
    "STREQUAL": lambda left, right: left == right,
    "MATCHES": lambda left, right: bool(re.search(right, left)),
    "IN_LIST": lambda left, right: left in right.split(";"),
    "EQUAL": lambda left, right: float(left) == float(right),
    "LESS": lambda left, right: float(left) < float(right),
    "GREATER": lambda left, right: float(left) > float(right),
    "VERSION_EQUAL": lambda left, right: _version(left) == _version(right),
    "VERSION_LESS": lambda left, right: _version(left) < _version(right),
    "VERSION_GREATER": lambda left, right: _version(left) > _version(right),
    "VERSION_LESS_EQUAL": lambda left, right: _version(left) <= _version(right),
    "VERSION_GREATER_EQUAL": lambda left, right: _version(left) >= _version(right),
}
