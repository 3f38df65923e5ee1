"""The errors of launch files: one sentence with the file and the line.

`LaunchService` and `ros2 launch` format every exception with `sentence`. Its place is the user's code in the traceback,
otherwise the line at which the action was created (`place_of_caller`, `locate`).
"""

from __future__ import annotations

import contextlib
import os
import sys
import sysconfig
import traceback
from collections.abc import Iterator
from contextvars import ContextVar

from gz_course.sim.error_text import named
from gz_course.sim.ros.launch.ament_prefix import nearest_package_of

_OWN_FOLDER = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))  # noqa: PTH100, PTH120 - at every start
_LAUNCH_ROOMS = ("launch", *(f"launch_{part}" for part in ("pytest", "ros", "testing", "testing_ros", "xml", "yaml")))
_OWN_ROOMS = (*_LAUNCH_ROOMS, "ros2")
_OWN_FOLDERS = tuple(os.path.join(_OWN_FOLDER, name) + os.sep for name in _OWN_ROOMS)  # noqa: PTH118
_LIBRARIES = tuple(
    folder + os.sep
    for folder in {sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib", "scripts")}
)
_WATCHING = f"{os.sep}course_agent{os.sep}"  # code of the grader in the processes that it watches
Place = tuple[str, int | str]
"""A file and a line, or a text `line:column`."""
_written_at: ContextVar[Place | None] = ContextVar("_written_at", default=None)


class LaunchError(Exception):
    """The base of errors of launch files; the text is one sentence for the user."""


class MissingArgumentError(LaunchError, RuntimeError):
    """A launch argument without a default was not given."""


class InvalidArgumentError(LaunchError, RuntimeError):
    """A launch argument has a value that its choices do not allow."""


class UsedTwiceError(LaunchError, RuntimeError):
    """An action that can only be executed once was executed again."""


class NotAvailableError(LaunchError, NotImplementedError):
    """A feature of the full ROS 2 that this package does not have."""


class NotTextError(LaunchError, TypeError):
    """A value in a place where text or a substitution is expected."""


def place_of_caller() -> Place | None:
    """Return file and line of the calling user code, or of the tag that is being read; None if there is neither."""
    written = _written_at.get()
    if written is not None:
        return written
    frame = sys._getframe(1)
    while frame is not None:
        path = frame.f_code.co_filename
        if _is_of_the_user(path):
            return path, frame.f_lineno
        frame = frame.f_back  # type: ignore[assignment]
    return None


@contextlib.contextmanager
def written_at(place: Place) -> Iterator[None]:
    """Let entities that are created in the block have this place, which is not in Python code."""
    token = _written_at.set(place)
    try:
        yield
    finally:
        _written_at.reset(token)


def locate(error: BaseException, place: Place | None) -> None:
    """Record where the failed entity was created, unless that is already recorded."""
    if place is not None and not hasattr(error, "launch_place"):
        error.launch_place = place  # type: ignore[attr-defined]


def sentence(error: BaseException) -> str:
    """Return the error as `file:line: text`; the text starts with the error's type unless it is a LaunchError."""
    if isinstance(error, SyntaxError) and error.filename:
        return f"{error.filename}:{error.lineno}: {type(error).__name__}: {error.msg}"
    # str() of a KeyError quotes its text; ament's PackageNotFoundError is one.
    text = str(error.args[0]) if isinstance(error, KeyError) and type(error) is not KeyError else str(error)
    text += nearest_package_of(text)
    if not isinstance(error, LaunchError):
        text = f"{type(error).__name__}: {text}" if text else named(error)
    place = _place_in(error)
    return text if place is None or text.startswith(f"{place[0]}:") else f"{place[0]}:{place[1]}: {text}"


def _place_in(error: BaseException) -> Place | None:
    frames = traceback.extract_tb(error.__traceback__)
    places = [(frame.filename, frame.lineno or 0) for frame in frames if _is_of_the_user(frame.filename)]
    return places[-1] if places else getattr(error, "launch_place", None)


def _is_of_the_user(path: str) -> bool:
    return not path.startswith(("<", *_OWN_FOLDERS, *_LIBRARIES)) and _WATCHING not in path
