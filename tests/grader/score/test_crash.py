"""The student's line in a traceback, and how it is quoted."""

from __future__ import annotations

import pytest

from gz_course.grader.score.crash import read_crash

TRACEBACK = [
    "[INFO] [node]: started",
    "Traceback (most recent call last):",
    '  File "/home/me/node.py", line 40, in <module>',
    "    main()",
    '  File "/home/me/node.py", line 12, in on_scan',
    "    CODE",
    '  File "/usr/lib/python3.11/site-packages/rclpy/node.py", line 7, in publish',
    "    raise TypeError()",
    "TypeError: no",
]


def of(code: str) -> list[str]:
    return [line.replace("CODE", code) for line in TRACEBACK]


def test_the_last_line_of_the_students_own_file_is_found():
    crash = read_crash(of("self.out.publish(1)"), "node.py")
    assert crash is not None
    assert (crash.error, crash.file, crash.line, crash.own) == ("TypeError: no", "node.py", "12", False)
    assert crash.place == "node.py, line 12: self.out.publish(1)"


@pytest.mark.parametrize(
    ("code", "quoted"),
    [
        ("stop_at = declare('stop_at', 1)  # [m]", "stop_at = declare('stop_at', 1)"),
        ("print('a # b')", "print('a # b')"),
        ("color = '#ff0000'", "color = '#ff0000'"),
    ],
)
def test_a_comment_is_not_quoted(code, quoted):
    crash = read_crash(of(code), "node.py")
    assert crash is not None
    assert crash.place == f"node.py, line 12: {quoted}"


def test_output_without_a_traceback_has_no_crash():
    assert read_crash(["[INFO] [node]: started"]) is None
