"""Rerun's viewer as a child process: a window, or a page for a browser, which only this machine can reach.

The binary is started directly, because its Python wrapper leaves it running when it is killed. `CI=1` is the only
switch that keeps it from collecting usage data; a page is kept from it by `page_server.py`.

Source: `rerun --help` of rerun-sdk 0.41
"""

from __future__ import annotations

import contextlib
import importlib.util
import os
import secrets
import signal
import socket
import subprocess
import sys
import threading
import urllib.parse
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from types import TracebackType

from gz_course.sim import machine_clock
from gz_course.sim.child_end import await_end
from gz_course.sim.show.rviz2.page_server import LOOPBACK, PageServer

START_S = 60.0  # [s] for the viewer to start up
GRACE_S = 3.0  # [s] between SIGINT, SIGTERM and SIGKILL
LOOK_AGAIN_S = 0.02
# Executes the command after asking Linux (prctl 1, PR_SET_PDEATHSIG) for a SIGTERM at the end of the process that
# started it: who is killed cannot clean up.
_LAUNCHER = """
import ctypes, os, signal, sys
signal.signal(signal.SIGINT, signal.SIG_DFL)
signal.pthread_sigmask(signal.SIG_SETMASK, [])
ctypes.CDLL(None).prctl(1, signal.SIGTERM)
if os.getppid() == int(sys.argv[1]):
    os.execv(sys.argv[2], sys.argv[2:])
"""


class ViewerError(Exception):
    """The viewer did not start; the text is one sentence."""


def binary() -> Path:
    """Return the viewer's executable file. Raises ViewerError if it is not installed."""
    spec = importlib.util.find_spec("rerun_cli")
    folders = spec.submodule_search_locations or [] if spec else []
    for path in (Path(folder) / "rerun" for folder in folders):
        if path.is_file():
            return path
    raise ViewerError("Rerun's viewer is not installed; `pip install --force-reinstall rerun-sdk` brings it")


def has_display() -> bool:
    """Return whether a window can be opened."""
    return any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))


class Viewer:
    """A viewer that shows what is sent to `stream_url`; it ends with its `with` block, or with this process.

    With `web` it is a page, and `address` is where a browser finds it; else it is a window. Use it from the main
    thread: Linux ends the viewer when the thread that started it ends.
    """

    def __init__(self, *, web: bool) -> None:
        """Start it. Raises ViewerError if it does not start."""
        self.web = web
        self._port, self._files_port = _free_ports()
        self._page: PageServer | None = None
        options = ["--bind", LOOPBACK, "--port", str(self._port), "--server-memory-limit", "500MB"]
        if web:
            options += ["--serve-web", "--web-viewer-port", str(self._files_port)]
            options += ["--cors-allow-origin", f"http://{LOOPBACK}:*"]
        else:
            options += ["--hide-welcome-screen", "--expect-data-soon"]
        self._log = bytearray()
        self._process = subprocess.Popen(
            [sys.executable, "-I", "-S", "-c", _LAUNCHER, str(os.getpid()), str(binary()), *options],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            env=os.environ | {"CI": "1", "NO_COLOR": "1"},
            start_new_session=True,
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        try:
            self._wait_until_it_answers()
            if web:
                self._page = PageServer(self._files_port)
        except BaseException:
            self.close()
            raise

    @property
    def stream_url(self) -> str:
        """Where a recording stream connects: `stream.connect_grpc(url)`."""
        return f"rerun+http://{LOOPBACK}:{self._port}/proxy"

    @property
    def address(self) -> str:
        """The page that shows the stream."""
        return self.address_of(self.stream_url)

    def address_of(self, url: str) -> str:
        """Return the page that shows the recording at a URL."""
        assert self._page is not None, "it is a window"
        return f"http://{LOOPBACK}:{self._page.port}/?url={urllib.parse.quote(url, safe='')}"

    @property
    def is_running(self) -> bool:
        """Whether it still runs: a window can be closed."""
        return self._process.poll() is None

    def check(self) -> None:
        """Raise ViewerError if it has ended with an error; closing its window is none."""
        if self._process.poll():
            advice = "" if self.web else "; try a browser, with --web"
            raise ViewerError(f"Rerun's viewer has ended: {self._last_words()}{advice}")

    def _last_words(self) -> str:
        """Return the last line in which it complains, else how it ended."""
        said = self._log.decode(errors="replace").splitlines()
        complaints = [each for each in said if any(word in each.lower() for word in ("error", "panic", "failed"))]
        ended = "no answer" if self.is_running else f"exit code {self._process.returncode}"
        return complaints[-1].strip()[:300] if complaints else ended

    def close(self) -> None:
        """End it as Ctrl-C would, if necessary with SIGTERM and SIGKILL."""
        if self._page is not None:
            self._page.close()
        for escalation in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self._process.pid, escalation)
            if await_end(self._process, GRACE_S) is not None:
                break
        self._process.wait()
        self._reader.join()

    def _read(self) -> None:
        """Take what it prints, so that it never waits for a reader; keep the end for an error sentence."""
        assert self._process.stdout is not None
        with self._process.stdout as output:
            for line in output:
                self._log += line
                del self._log[:-4000]

    def _wait_until_it_answers(self) -> None:
        end = machine_clock.now() + START_S
        for port in (self._port, self._files_port) if self.web else (self._port,):
            while True:
                with contextlib.suppress(OSError), socket.create_connection((LOOPBACK, port), timeout=1.0):
                    break
                if not self.is_running or machine_clock.now() > end:
                    raise ViewerError(f"Rerun's viewer does not start: {self._last_words()}")
                machine_clock.pause(LOOK_AGAIN_S)

    def __enter__(self) -> Viewer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class FileServer:
    """Serves one recording to pages of a viewer, at a URL that cannot be guessed."""

    def __init__(self, path: Path) -> None:
        name = f"/{secrets.token_urlsafe(16)}/{path.name}"

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                if urllib.parse.unquote(self.path) != name:
                    self.send_error(404)
                    return
                with path.open("rb") as file:
                    self.send_response(200)
                    self.send_header("Content-Type", "application/octet-stream")
                    self.send_header("Content-Length", str(os.fstat(file.fileno()).st_size))
                    # Who knows the URL may read it: a page of the viewer, whatever its port.
                    self.send_header("Access-Control-Allow-Origin", "*")
                    self.end_headers()
                    with contextlib.suppress(ConnectionError):
                        self.copyfile(file)

            def copyfile(self, file: object) -> None:
                while block := file.read(1 << 20):  # type: ignore[attr-defined]
                    self.wfile.write(block)

            def log_message(self, format: str, *args: object) -> None:
                pass

        self._server = ThreadingHTTPServer((LOOPBACK, 0), Handler)
        self._server.daemon_threads = True
        self.url = f"http://{LOOPBACK}:{self._server.server_address[1]}{urllib.parse.quote(name)}"
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def __enter__(self) -> FileServer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _free_ports() -> tuple[int, int]:
    """Return two ports that nothing on this machine listens on."""
    with socket.socket() as one, socket.socket() as other:
        one.bind((LOOPBACK, 0))
        other.bind((LOOPBACK, 0))
        return one.getsockname()[1], other.getsockname()[1]
