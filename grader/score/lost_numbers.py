"""Numbers that were lost on their way into a message, because they were no floats of Python.

rclpy does not convert what is assigned to a floating-point field: it reads the eight bytes that a Python float has at
the place where it keeps its value. An int has its length there, NumPy's float32 its four bytes; read as eight bytes,
both are numbers so near to 0 that nothing else makes them.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding

TINY = 1e-300  # below it are only such numbers
LONGEST_INT = 1 << 20  # bits that are as few as that are the length of an int, and none of a float32


def lost_number(recording: Recording, findings: Iterable[Finding] = ()) -> str:
    """Return one sentence about the first field whose numbers were lost; empty if there is none."""
    facts = recording.facts()
    if facts.get("whole_numbers"):
        return ""  # named with its line
    for topic in facts.get("listened", {}):
        base = f"topics/{topic.strip('/')}/"
        for name in recording.signals():
            values = recording.signal(name).values if name.startswith(base) else np.empty(0)
            lost = values[(np.abs(values) < TINY) & (values != 0)]
            if len(lost):
                return _words(topic, name.removeprefix(base).replace("/", "."), lost[:1])
    return ""


def _words(topic: str, field: str, lost: np.ndarray) -> str:
    bits = int(np.abs(lost).view(np.int64)[0])
    if bits < LONGEST_INT:
        what = "a whole number (an int, or a bool)"
    else:
        value = float(np.array([bits & 0xFFFFFFFF], dtype=np.uint32).view(np.float32)[0])
        what = f"a number of NumPy's type float32 ({value:.3g})"
    return (
        f"{field} of what you publish on {topic} is given {what}, which is no float of Python; rclpy does not convert "
        "it and sends 0: write float(...)."
    )
