"""What the processes of a submission write: lines from their two pipes, cut and counted.

After `MOST_LINES` only the end is kept, for the reason why a program ended stands there.
"""

from __future__ import annotations

import os
import selectors
from collections.abc import Sequence
from typing import IO

LONGEST_LINE = 2_000  # [characters] kept of one line
MOST_LINES = 20_000  # kept per run
# kept of the rest if the submission ends by itself, because the reason stands there; lines in between are counted
LAST_BYTES = 64 << 10
MOST_READ = 1 << 20  # [bytes] read from a pipe in one call, so that an endless writer does not stop the grader
SHOWN_FOLDER = b"/submission"  # name of the submission's folder in its log


class SubmissionLog:
    """The lines of two pipes, which `selector` watches until they end. The folder `shown` appears as `/submission`."""

    def __init__(self, pipes: Sequence[IO[bytes]], selector: selectors.BaseSelector, shown: str) -> None:
        self._pipes = pipes
        self._selector = selector
        self.folder = shown
        self._partial: dict[int, bytes] = {}
        self._lines: list[str] = []
        self._line_count = 0
        self._last = b""  # end of what was written beyond the limit
        self._last_taken = 0  # lines
        for pipe in pipes:
            os.set_blocking(pipe.fileno(), False)
            self._partial[pipe.fileno()] = b""
            selector.register(pipe, selectors.EVENT_READ)

    @property
    def dropped_lines(self) -> int:
        """Lines beyond the limit that were read and discarded."""
        return max(0, self._line_count - MOST_LINES - self._last_taken)

    def take_lines(self) -> list[str]:
        """Return the lines written since the last call."""
        lines, self._lines = self._lines, []
        return lines

    def read(self) -> None:
        """Empty the pipes, as far as `MOST_READ` goes."""
        for pipe in self._pipes:
            self._drain(pipe.fileno())

    def finish(self) -> None:
        """Note the end of what was written beyond the limit."""
        last = self._last.removesuffix(b"\n").split(b"\n") if self._last else []
        if len(self._last) == LAST_BYTES:
            del last[0]  # remove an incomplete line
        for line in last:
            self._note(line)
        self._last, self._last_taken = b"", self._last_taken + len(last)

    def close(self) -> None:
        """Close the pipes."""
        for pipe in self._pipes:
            pipe.close()

    def _drain(self, fd: int) -> None:
        left = MOST_READ
        while fd in self._partial and left > 0:
            try:
                data = os.read(fd, 1 << 16)
            except BlockingIOError:
                return
            left -= len(data)
            if not data:
                self._selector.unregister(fd)
                rest = self._partial.pop(fd)
                if rest:
                    self._keep(rest)
                return
            if self._line_count > MOST_LINES:  # not line by line, which is slower than a flood is written
                self._line_count += data.count(b"\n")
                self._last = (self._last + self._partial[fd] + data)[-LAST_BYTES:]
                self._partial[fd] = b""
                continue
            *whole, rest = (self._partial[fd] + data).split(b"\n")
            for line in whole:
                self._keep(line)
            self._partial[fd] = rest[: 4 * LONGEST_LINE]

    def _keep(self, line: bytes) -> None:
        self._line_count += 1
        if self._line_count <= MOST_LINES:
            self._note(line)
        else:
            self._last += line + b"\n"

    def _note(self, line: bytes) -> None:
        if self.folder:
            line = line.replace(self.folder.encode(), SHOWN_FOLDER)  # the real path differs between equal runs
        self._lines.append(line.decode(errors="replace")[:LONGEST_LINE])
