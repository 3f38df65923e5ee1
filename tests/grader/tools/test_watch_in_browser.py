"""The frame of `room.watch` in a page as a notebook has it: it shows Rerun's page, and asks no other machine."""

from __future__ import annotations

import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

import pytest

from gz_course.grader.tools.playground import Playground
from gz_course.tests.browser import DEADLINE, TRY, eventually, needs_chromium, watched_chromium


@pytest.mark.proof
@needs_chromium
def test_a_page_asks_no_other_machine() -> None:
    shown = ""

    class Notebook(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(shown.encode())

        def log_message(self, *_: object) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Notebook)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    with Playground() as room, watched_chromium() as (browser, outside):
        frame = room.watch("/chatter")
        assert frame.address, frame
        shown = frame._repr_mimebundle_()["text/html"]
        page = browser.new_page()
        page.set_default_timeout(DEADLINE * 1000)
        said: list[Any] = []
        page.on("console", lambda message: said.append(message.text))
        page.goto(f"http://localhost:{server.server_address[1]}/")
        eventually(lambda: page.wait_for_timeout(50) or any("App started" in each for each in said), "the viewer")
        (inner,) = page.frames[1:]
        assert inner.url.startswith("http://127.0.0.1:")
        inner.evaluate(TRY)
        page.close()
    server.shutdown()
    server.server_close()
    assert outside.asked == set()
