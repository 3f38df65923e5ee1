"""The process of a view: `python -m gz_course.sim.gz.view`; started by `gz sim`, `gz sim -g` and `open_view`.

It says one line on stdout: the address of the page and one for the browser, or `! ` and why there is no view. The end
of stdin ends the view, so that it never outlives the process that has started it.
"""

from __future__ import annotations

import argparse
import logging
import os
import signal
import sys
import threading
from collections.abc import Sequence
from typing import TYPE_CHECKING

from gz_course.sim.gz.transport import Node

if TYPE_CHECKING:
    from gz_course.sim.gz.view.gate import Gate
    from gz_course.sim.gz.view.world_link import WorldLink

NO_STUDIO, NOT_OPEN, BROKEN = 3, 4, 5
"""Exit codes: MuJoCo Studio is missing or another one than expected; the address cannot be opened; an error later."""
_SEARCH_S = 0.5
_END_S = 2.0
"""Time [s] in which Studio may say goodbye to the browsers."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Open a view and serve it until stdin or a signal ends it; return the exit code."""
    parser = argparse.ArgumentParser(prog="gz_course.sim.gz.view")
    parser.add_argument("--bind", default="127.0.0.1", help="address to listen on")
    parser.add_argument("--port", type=int, default=0, help="0: any free one")
    parser.add_argument("--world", default="", help="name of the world")
    parser.add_argument("--search", action="store_true", help="show the first world that answers instead")
    values = parser.parse_args(arguments)
    say = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # Studio prints its own address, without the token
    ended = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: threading.Thread(target=ended.set, daemon=True).start())
    from gz_course.sim.gz.view.gate import Gate, StudioChanged, check, install

    try:
        gate = Gate(values.bind, values.port, values.world or "gz sim")
    except OSError as error:
        say.write(f"! it cannot listen on {values.bind} ({error.strerror or error})\n")
        return NOT_OPEN
    try:
        from mujoco.studio import launch_thread, messages, viewer_protocol, web_viewer
        from mujoco.studio.web import web_server

        from gz_course.sim.gz.sim.systems.view_broadcaster import STATE
        from gz_course.sim.gz.view.window import Window
        from gz_course.sim.gz.view.world_link import WorldLink
    except (ImportError, AttributeError) as error:
        say.write(f"! MuJoCo Studio is not here ({error}); pip install mujoco brings it\n")
        return NO_STUDIO
    logging.getLogger("WebServer").handlers.clear()
    for logger in (logging.getLogger("WebServer"), logging.getLogger()):
        logger.addHandler(logging.NullHandler())
    try:
        node = Node()
    except (OSError, RuntimeError, ValueError) as error:
        say.write(f"! the transport cannot be opened ({error}); check GZ_IP and GZ_PARTITION\n")
        return NOT_OPEN
    viewer_end, world_end = launch_thread.make_thread_endpoints()
    link = WorldLink(
        node,
        lambda model: world_end.send_to_viewer(messages.ModelEvent(model=model)),
        lambda state: world_end.send_to_viewer(messages.StateSnapshot(state=state, state_sig=STATE)),
    )

    class WebViewer(web_viewer.WebViewer):
        def prepare_next_frame(self) -> bool:
            gate.wait_until_drawn()
            return bool(super().prepare_next_frame())

    window = Window(link)
    gate.tell = window.told
    try:
        install(gate, web_server)
        viewer = WebViewer(viewer_protocol.ViewerConfig(gfx="web"), viewer_end, plugins=[window])
        check(gate)
    except StudioChanged as error:
        say.write(f"! {error}\n")
        say.flush()
        os._exit(NO_STUDIO)  # Studio may be serving without the gate
    say.write(f"{gate.address} {gate.address_for_browser()}\n")
    threading.Thread(target=_wait_for_end, args=(ended,), daemon=True).start()
    threading.Thread(target=_find, args=(values.world, link, gate, ended), daemon=True).start()

    def leave() -> None:
        ended.wait()
        last = threading.Timer(_END_S, os._exit, (0,))  # a browser that does not answer holds Studio up
        last.daemon = True
        last.start()
        world_end.send_to_viewer(messages.ExitEvent(reason=""))

    threading.Thread(target=leave, daemon=True).start()
    try:
        viewer_protocol.run_viewer_loop(viewer)
    except Exception as error:
        say.write(f"! it broke down: {' '.join(f'{type(error).__name__}: {error}'.split())}\n")
        return BROKEN
    finally:
        ended.set()
        window.close()
        link.close()
        link.node.close()
    return 0


def _find(name: str, link: WorldLink, gate: Gate, ended: threading.Event) -> None:
    """Show the world of this name, or the first one that answers."""
    while not name and not ended.is_set():
        name = link.find_world()
        if not name:
            ended.wait(_SEARCH_S)
    if not ended.is_set():
        gate.title = name
        link.follow(name)


def _wait_for_end(ended: threading.Event) -> None:
    while sys.stdin.readline():
        pass
    ended.set()
