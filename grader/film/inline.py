"""A recording inside a notebook: `recording_frame(report.recording)`, with its time line and a still picture."""

from __future__ import annotations

import atexit
import contextlib
import tempfile
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.film.film import snapshot
from gz_course.grader.record.reading import Recording
from gz_course.sim.show.rviz2.inline import Frame
from gz_course.sim.show.rviz2.viewer import FileServer, Viewer, ViewerError

STILL = (800, 500)  # [px]


class _Pages:
    """The one viewer of this process and the recordings it shows; they end with the process."""

    def __init__(self) -> None:
        self._stack = contextlib.ExitStack()
        self._viewer: Viewer | None = None
        self._servers: dict[Path, FileServer] = {}

    def address(self, path: Path) -> str:
        if self._viewer is None or not self._viewer.is_running:
            self._viewer = self._stack.enter_context(Viewer(web=True))
            atexit.register(self.close)
        if path not in self._servers:
            self._servers[path] = self._stack.enter_context(FileServer(path))
        return self._viewer.address_of(self._servers[path].url)

    def close(self) -> None:
        atexit.unregister(self.close)
        self._stack.close()
        self._viewer, self._servers = None, {}


PAGES = _Pages()


def recording_frame(path: Path | str, at_s: float | None = None, height: int = 560) -> Frame:
    """Return the frame of a recording for a notebook; its still picture is of a time [s], by default the middle.

    Raises UsageError for what is no recording, and if no viewer starts.
    """
    path = Path(path).resolve()
    recording = Recording(path)
    run = recording.properties("run")
    words = f"Recording of {run.get('exercise', path.stem)}, {run.get('submission', '')}".rstrip(", ")
    still = _still(recording, recording.end_ns / 2e9 if at_s is None else at_s)
    return Frame(_address(path), words, still, height)


def _address(path: Path) -> str:
    try:
        return PAGES.address(path)
    except ViewerError as error:
        raise UsageError(str(error)) from None


def _still(recording: Recording, at_s: float) -> bytes:
    with tempfile.TemporaryDirectory(prefix="course-still-") as folder:
        picture = Path(folder) / "still.png"
        with contextlib.suppress(UsageError):  # a run without a world has no picture
            snapshot(recording, at_s, picture, STILL)
            return picture.read_bytes()
    return b""
