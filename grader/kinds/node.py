"""`kind = "node"`: the submission is a Python file with an rclpy node; the exercise's bridge joins it to the robot."""

from __future__ import annotations

import io
import tokenize
import warnings
from typing import TYPE_CHECKING

from grader.kinds.kind import Cast, Kind
from grader.printable import shown
from grader.wall_clock import wall_clock

if TYPE_CHECKING:
    from grader.exercise import Exercise
    from grader.submission import Submission


def fault(name: str, content: bytes) -> str | None:
    """Say why a file is not Python, with its line."""
    try:
        # compile() passes bytes in a comment that are not UTF-8; Python, which is given the file, does not.
        content.decode(tokenize.detect_encoding(io.BytesIO(content).readline)[0])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an odd escape in a student's string is not our business
            compile(content, name, "exec", dont_inherit=True)
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        return shown(f"{name}, line {line}: this is not {error.encoding}: byte 0x{content[error.start]:02x}")
    except SyntaxError as error:
        line_number = f"{name}, line {error.lineno}" if error.lineno else name
        code = f": {error.text.strip()}" if error.text and error.text.strip() else ""
        return shown(f"{line_number}: {type(error).__name__}: {error.msg}{code}")
    except (ValueError, RecursionError, MemoryError, LookupError) as error:
        return shown(f"{name} cannot be read as Python: {type(error).__name__}: {error}")
    return None


def cast(exercise: Exercise, submission: Submission) -> Cast:
    """The student's node, and the bridge of the exercise."""
    from grader.run.exercise_bridge import exercise_bridge

    clocks = [{"file": shown(submission.main)} | place for place in wall_clock(submission.files[submission.main])]
    return Cast(submission.main, submission.files, exercise_bridge(exercise), {"wall_clock": clocks} if clocks else {})


KIND = Kind((".py",), fault, cast)
