"""A viewer's page for a person: opened in a browser if there is a desktop, told in any case, served until Ctrl-C."""

from __future__ import annotations

import contextlib
import signal
import threading
import webbrowser
from collections.abc import Iterator

from gz_course.sim.show.rviz2.viewer import Viewer, has_display

LOOK_AGAIN_S = 0.2
ENDS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def open_browser(address: str, *, wanted: bool = True) -> None:
    """Print the address of a page, and open it in a browser if there is a desktop and it is `wanted`."""
    opened = wanted and has_display() and webbrowser.open(address)
    print(f"{'shown' if opened else 'open this page in a browser'}: {address}", flush=True)
    print("Ctrl-C ends it", flush=True)


@contextlib.contextmanager
def ending() -> Iterator[threading.Event]:
    """Yield an event that is set by SIGINT, SIGTERM and SIGHUP."""
    ended = threading.Event()
    before = {number: signal.signal(number, lambda *_: ended.set()) for number in ENDS}
    try:
        yield ended
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def until_ctrl_c(viewer: Viewer) -> None:
    """Wait for Ctrl-C. Raises ViewerError if the viewer ends before that with an error."""
    with ending() as ended:
        while viewer.is_running and not ended.wait(LOOK_AGAIN_S):
            pass
    viewer.check()
