"""The assertions about what processes have printed."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

from gz_course.sim.ros.launch_testing.tools.text import build_text_match
from gz_course.sim.ros.launch_testing.util.proc_lookup import Target, resolveProcesses

# Source: ECMA-48, control sequences (CSI).
_ANSI_SEQUENCE = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]")


def assertInStream(
    proc_output: Any,
    expected_output: Any,
    process: Target,
    cmd_args: Any = None,
    *,
    output_filter: Callable[[str], str] | None = None,
    strict_proc_matching: bool = True,
    strip_ansi_escape_sequences: bool = True,
    stream: str = "stderr",
) -> None:
    """Assert that a process has printed this on `stream`: a text, a pattern, or a list of them in this order.

    `process` is an action, a part of the process's name, or None for all; `output_filter(text)` changes the output
    before the comparison. Raises NoMatchingProcessException for a process that is not known.
    """
    actions: list[Any] = resolveProcesses(
        proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching
    )
    if output_filter is not None and not callable(output_filter):
        raise ValueError("output_filter is not callable")
    if stream not in ("stdout", "stderr"):
        raise ValueError(f"stream is {stream!r}; it can be 'stdout' or 'stderr'")
    match = build_text_match(expected_output)
    for action in actions:
        printed = b"".join(event.text for event in proc_output[action] if getattr(event, f"from_{stream}"))
        text = printed.decode(errors="replace")
        if strip_ansi_escape_sequences:
            text = _ANSI_SEQUENCE.sub("", text)
        if output_filter is not None:
            text = output_filter(text)
        if match(text) is not None:
            return
    names = ", ".join(sorted(action.process_details["name"] for action in actions))
    raise AssertionError(f"Did not find '{expected_output}' in output for any of the matching processes: {names}")


def assertInStdout(*args: Any, **kwargs: Any) -> None:
    """Assert what a process has printed on stdout; arguments as of `assertInStream`."""
    assertInStream(*args, **kwargs, stream="stdout")


def assertInStderr(*args: Any, **kwargs: Any) -> None:
    """Assert what a process has printed on stderr; arguments as of `assertInStream`."""
    assertInStream(*args, **kwargs, stream="stderr")
