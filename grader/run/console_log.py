"""Which lines of a program's output were logged: those whose message came on /rosout, too.

A line has its time and its place in the order from the output; that it looks like a log message proves nothing, because
`print` writes what it is told to write. The recording gets the numbers of the lines that look logged and are not.
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict, deque
from typing import Any

LOOKS_LOGGED = re.compile(r"^\[[A-Z]+\] \[[^\]]*\]: ")
SEVERITIES = {10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "FATAL"}  # of rcl_interfaces/msg/Log
MOST_WAITING = 20_000  # messages on /rosout whose line has not come


class ConsoleLog:
    """The lines of one run and the messages on /rosout, matched by their text, each message with one line."""

    def __init__(self, shown: str, longest: int, replaced: str) -> None:
        """Expect lines that were cut after `longest` characters, with `replaced` for every `shown`."""
        self._shown, self._longest, self._replaced = shown, longest, replaced
        self._number = 0
        self._lines: dict[str, deque[int]] = defaultdict(deque)  # text -> numbers of lines without a message
        self._messages: Counter[str] = Counter()  # text -> messages without a line
        self._waiting = 0  # of those

    def line(self, text: str) -> None:
        """Take the next line of the output."""
        number, self._number = self._number, self._number + 1
        if not LOOKS_LOGGED.match(text):
            return
        if self._messages[text]:
            self._messages[text] -= 1
            self._waiting -= 1
        else:
            self._lines[text].append(number)

    def message(self, log: Any) -> None:
        """Take a message of /rosout (rcl_interfaces/msg/Log)."""
        text = f"[{SEVERITIES.get(log.level, 'UNKNOWN')}] [{log.name}]: {log.msg}"
        for number, line in enumerate(text.split("\n")):
            if number and not LOOKS_LOGGED.match(line):
                continue
            if self._shown:
                line = line.replace(self._shown, self._replaced)
            line = line[: self._longest]
            if waiting := self._lines.get(line):
                waiting.popleft()
            elif self._waiting < MOST_WAITING:
                self._messages[line] += 1
                self._waiting += 1

    def not_logged(self) -> list[int]:
        """Return the numbers, from 0, of the lines that look logged and are not."""
        return sorted(number for numbers in self._lines.values() for number in numbers)
