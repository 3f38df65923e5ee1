"""The assertion about the order of what a process has printed."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from typing import Any

from gz_course.sim.ros.launch_testing.util.proc_lookup import Target, resolveProcesses

_NEARBY = 3  # lines before and after the last match that an error shows


class SequentialTextChecker:
    """Looks for texts one after the other in the pieces of an output."""

    def __init__(self, output: Sequence[str]) -> None:
        self._text = "".join(output)
        self._position = 0

    def assertInStdout(self, msg: str) -> None:
        """Assert that this text comes after the one found last."""
        found = self._text.find(msg, self._position)
        assert found >= 0, (
            f"'{msg}' not found in sequence after previous match.  "
            f"The output near the last matched line:\n{self.get_nearby_lines()}"
        )
        self._position = found + len(msg)

    assertInText = assertInStdout

    def get_nearby_lines(self) -> str:
        before = self._text[: self._position].splitlines(keepends=True)
        after = self._text[self._position :].splitlines(keepends=True)
        return "".join(before[-_NEARBY:] + after[:_NEARBY])


@contextlib.contextmanager
def assertSequentialStdout(proc_output: Any, process: Target, cmd_args: Any = None) -> Iterator[SequentialTextChecker]:
    """Return a context whose value has `assertInStdout(text)`, for texts in the order of the output of one process."""
    action = resolveProcesses(proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=True)[0]
    yield SequentialTextChecker([event.text.decode(errors="replace") for event in proc_output[action]])
