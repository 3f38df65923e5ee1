"""Compares the output of a process with what is expected, without lines that do not matter."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from gz_course.sim.ros.launch_testing.tools.text import build_line_match, build_text_match


def get_default_filtered_prefixes() -> list[str]:
    return ["pid", "rc"]


def get_default_filtered_patterns() -> list[str]:
    return []


def basic_output_filter(
    filtered_prefixes: Iterable[str] | None = None, filtered_patterns: Iterable[str] | None = None
) -> Callable[[str], str]:
    """Return a function that drops lines that begin with a prefix (`pid` and `rc` by default) or match a pattern."""
    prefixes = tuple(get_default_filtered_prefixes() if filtered_prefixes is None else filtered_prefixes)
    texts = get_default_filtered_patterns() if filtered_patterns is None else filtered_patterns
    patterns = [re.compile(text) for text in texts]

    def keep(output: str) -> str:
        lines = output.splitlines(keepends=True)
        return "".join(
            line for line in lines if not line.startswith(prefixes) and not any(p.match(line) for p in patterns)
        )

    return keep


def expected_output_from_file(path: str) -> list[Any]:
    """Return the lines of `path`.txt, or the patterns of `path`.regex. Raises RuntimeError if there is neither."""
    literal, patterns = Path(f"{path}.txt"), Path(f"{path}.regex")
    if literal.is_file():
        return list(literal.read_text().splitlines())
    if patterns.is_file():
        return [re.compile(line) for line in patterns.read_text().splitlines()]
    raise RuntimeError(f"could not find output check file: {path}")


def expect_output(
    *,
    text: str | None = None,
    lines: list[str] | None = None,
    expected_text: Any = None,
    expected_lines: Any = None,
    strict: bool = False,
) -> bool:
    """Return whether `text`, or `lines`, hold `expected_text`, or `expected_lines`. Raises ValueError for both."""
    if (text is None) == (lines is None):
        raise ValueError("Either lines or text, but not both, must be specified")
    if (expected_text is None) == (expected_lines is None):
        raise ValueError("Either expected lines or text, but not both, must be specified")
    whole = "\n".join(lines or []) if text is None else text
    if expected_lines is not None:
        match = build_line_match(expected_lines, strict=strict)
        found = match(whole.splitlines() if lines is None else lines)
        count = len(whole.splitlines()) if lines is None else len(lines)
    else:
        found = build_text_match(expected_text, strict=strict)(whole)
        count = len(whole)
    return found is not None and (not strict or found == (0, count))
