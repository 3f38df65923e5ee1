"""The renderer of `gz sim`: it casts rays, and draws with OpenGL instead where that works and is faster.

After some images it looks for OpenGL, in a process of its own beside the simulation, and then measures both on the next
ones. Short runs cast all their rays, so they cost nothing more and have equal bytes.
"""

from __future__ import annotations

import atexit
import subprocess
import sys
import time
from typing import TYPE_CHECKING

from gz_course.sim.gz.sim.errors import LOG
from gz_course.sim.gz.sim.rendering.gl_renderer import BACKENDS, PROBE, PROBE_SECONDS, GlRenderer
from gz_course.sim.gz.sim.rendering.ray_renderer import RayRenderer
from gz_course.sim.gz.sim.rendering.shading import Colours

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.rendering.camera_sensor import CameraSensor
    from gz_course.sim.gz.sim.rendering.renderer import Renderer

PATIENCE = 20
"""Images before OpenGL is looked for."""
TRIES = 3
"""Images that both renderers make, to find the quicker one."""


class OpenGlSearch:
    """Looks for OpenGL in child processes, without waiting for them."""

    def __init__(self) -> None:
        self._waiting = list(BACKENDS)
        self._process: subprocess.Popen[str] | None = None
        self._began = 0.0
        self.done = False
        self.backend = ""
        """`egl` or `osmesa`, empty if neither works."""

    def look(self) -> None:
        """Start the next process, or take the answer of one that has ended."""
        if self.done:
            return
        if self._process is not None:
            if self._process.poll() is None and time.monotonic() - self._began < PROBE_SECONDS:
                return
            works = self._process.poll() == 0 and self._process.communicate()[0].strip().endswith("works")
            tried = self._waiting.pop(0)
            self.end()
            if works:
                self.backend, self.done = tried, True
                return
        if not self._waiting:
            self.done = True
            return
        self._began = time.monotonic()
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-c", PROBE, self._waiting[0]],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
                start_new_session=True,
            )
            atexit.register(self.end)
        except OSError:
            self.done = True

    def end(self) -> None:
        """End the process that still runs."""
        if self._process is None:
            return
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()
        if self._process.stdout is not None:
            self._process.stdout.close()
        self._process = None
        atexit.unregister(self.end)


SEARCH = OpenGlSearch()


class QuickerRenderer:
    """Renders with the quicker of ray casting and OpenGL."""

    def __init__(self, camera: CameraSensor, search: OpenGlSearch = SEARCH) -> None:
        self._camera, self._search = camera, search
        self._cast = RayRenderer(camera)
        self._drawn: GlRenderer | None = None
        self._images = 0
        self._times: list[tuple[float, float]] = []
        self.chosen: Renderer | None = None
        """The renderer of all further images, None before it is known."""

    def bind(self) -> None:
        self._cast.bind()
        if self._drawn is not None and self.chosen is not self._cast:
            self._drawn.bind()

    def image(self) -> Colours:
        if self.chosen is not None:
            return self.chosen.image()
        self._images += 1
        if self._images <= PATIENCE:
            return self._cast.image()
        self._search.look()
        if not self._search.done:
            return self._cast.image()
        if not self._search.backend:
            self.chosen = self._cast
            return self._cast.image()
        return self._compare()

    def _compare(self) -> Colours:
        """Return the cast image; measure both renderers."""
        begin = time.perf_counter()
        cast = self._cast.image()
        middle = time.perf_counter()
        try:
            if self._drawn is None:
                self._drawn = GlRenderer(self._camera, self._search.backend)
                self._drawn.bind()
                return cast  # the first image costs more than the others
            self._drawn.image()
        except Exception as error:  # a driver may fail in any way
            LOG.info("OpenGL does not draw for camera '%s' (%s), rays are cast", self._camera.scoped_name, error)
            self.chosen = self._cast
            return cast
        self._times.append((middle - begin, time.perf_counter() - middle))
        if len(self._times) >= TRIES:
            casting, drawing = (min(each) for each in zip(*self._times, strict=True))
            self.chosen = self._drawn if drawing < casting else self._cast
            engine = "OpenGL" if drawing < casting else "ray casting"
            text = "camera '%s' is drawn with %s (%.1f ms cast, %.1f ms drawn)"
            LOG.info(text, self._camera.scoped_name, engine, casting * 1e3, drawing * 1e3)
        return cast
