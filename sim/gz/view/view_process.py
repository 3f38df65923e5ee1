"""Open a view of a running world in a process of its own: the function that `gz sim` and notebooks call.

    with open_view("lidar_room") as view:
        print(view.address)

The process draws nothing itself; the browser does. It ends with `close`, and with this process.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import threading
import webbrowser
from collections.abc import Callable, Mapping
from types import TracebackType

from gz_course.sim.child_end import await_end
from gz_course.sim.jupyter_proxy import reachable

_END_S = 3.0
"""Time [s] for the process to end after each of stdin's end, SIGTERM and SIGKILL."""


class ViewError(RuntimeError):
    """There is no view; the text says why in one sentence."""


class View:
    """A view process; the address is known as soon as it listens, see `wait`."""

    def __init__(
        self,
        world: str = "",
        *,
        bind: str = "127.0.0.1",
        port: int = 0,
        search: bool = False,
        environment: Mapping[str, str] | None = None,
        on_ready: Callable[[View], object] | None = None,
        on_end: Callable[[View], object] | None = None,
    ) -> None:
        """Start the process; without a name, `search` shows the first world that answers.

        `environment` replaces that of this process, for example to look into another GZ_PARTITION. From a thread,
        `on_ready` is called once the page can be opened, and `on_end` if the process ends before `close`.
        """
        command = [sys.executable, "-m", "gz_course.sim.gz.view", "--bind", bind, "--port", str(port)]
        if world:
            command += ["--world", world]
        if search:
            command += ["--search"]
        self._process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            bufsize=1,
            process_group=0,  # Ctrl-C is for the owner, which ends the view
            env=None if environment is None else dict(environment),
        )
        self.address = ""
        """The address of the page with its token, as the user's browser reaches it; empty until it listens."""
        self.error = ""
        """Why there is no view."""
        self._once = ""
        self._on_ready, self._on_end = on_ready, on_end
        self._closing = False
        self._said = threading.Event()
        self._thread = threading.Thread(target=self._listen, daemon=True)
        self._thread.start()

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def running(self) -> bool:
        """Return whether the process lives."""
        return self._process.poll() is None

    def _listen(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            if line.startswith("! "):
                self.error = line[2:].strip()
            elif not self.address:
                address, _, self._once = line.strip().partition(" ")
                self.address = reachable(address)
                self._said.set()
                if self._on_ready is not None:
                    self._on_ready(self)
        code = self._process.wait()
        if not self._closing:
            self.error = self.error or f"its process has ended with code {code}"
        self._said.set()
        if not self._closing and self._on_end is not None:
            self._on_end(self)

    def wait(self, timeout: float = 60.0) -> View:
        """Wait until the page can be opened. Raises ViewError if there is no view."""
        if not self._said.wait(timeout):
            raise ViewError(f"the view has not come within {timeout:g} s")
        if not self.address or not self.running:
            raise ViewError(self.error or "the view was closed")
        return self

    def open_browser(self) -> bool:
        """Open the page in the browser of the desktop; return False if there is none."""
        if not self._once or not has_desktop():
            return False
        opened = webbrowser.open(self._once, new=2)
        self._once = ""
        return opened

    def close(self) -> None:
        """End the process, politely first."""
        self._closing = True
        process = self._process
        assert process.stdin is not None and process.stdout is not None
        with contextlib.suppress(OSError):
            process.stdin.close()
        ways = [process.terminate, process.kill]
        if not self._said.is_set():  # it is starting up and does not read yet
            ways.pop(0)()
        for way in ways:
            if await_end(process, _END_S) is not None:
                break
            way()
        process.wait()
        self._thread.join(_END_S)
        process.stdout.close()

    def __enter__(self) -> View:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def open_view(
    world: str,
    *,
    bind: str = "127.0.0.1",
    port: int = 0,
    environment: Mapping[str, str] | None = None,
    timeout: float = 60.0,
) -> View:
    """Open a view of the running world of this name and wait for its address.

    Raises ViewError with one sentence if that is not possible, for example without MuJoCo Studio.
    """
    view = View(world, bind=bind, port=port, environment=environment)
    try:
        return view.wait(timeout)
    except ViewError:
        view.close()
        raise


def has_desktop() -> bool:
    """Return whether a browser window can appear here."""
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")) or sys.platform == "darwin"
