"""The page of Rerun's viewer and one recording, from a server of ours that keeps the page on this machine.

Rerun's own web server sends no policy, and its page loads fonts, reports usage and asks for a service of its makers; it
has no switch against that (`CI=1` is for the window). Here the files of that server come with a policy under which a
browser asks nobody but this machine, and without the links that a browser follows in spite of it.

Source: https://www.w3.org/TR/CSP3/ ; https://www.w3.org/TR/resource-hints/ (a preconnect is no fetch)
"""

from __future__ import annotations

import contextlib
import http.client
import re
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import TracebackType

from gz_course.sim.page_policy import LOOPBACK_SOURCES, policy

LOOPBACK = "127.0.0.1"
ANSWER_S = 30.0  # [s] for Rerun's server to send a file
BLOCK = 1 << 20  # [B] that are passed on at once
FOREIGN_LINK = re.compile(rb"<link\b[^>]*\bhref=[\"']?(?:https?:)?//[^>]*>", re.IGNORECASE)
PASSED_ON = ("Content-Type", "rerun-final-length")  # the second one is for the bar of the page
HEADERS = {
    "Content-Security-Policy": policy(LOOPBACK_SOURCES),
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}


class PageServer:
    """Serves the files of Rerun's web server at `upstream_port` with `HEADERS`, to this machine."""

    def __init__(self, upstream_port: int) -> None:
        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                with contextlib.suppress(ConnectionError):  # the page was closed meanwhile
                    self._pass_on()

            def _pass_on(self) -> None:
                upstream = http.client.HTTPConnection(LOOPBACK, upstream_port, timeout=ANSWER_S)
                with contextlib.closing(upstream):
                    try:
                        upstream.request("GET", self.path)
                        answer = upstream.getresponse()
                    except (OSError, http.client.HTTPException):
                        self.send_error(502, "the viewer has ended")
                        return
                    self.send_response(answer.status)
                    for name in PASSED_ON:
                        if value := answer.getheader(name):
                            self.send_header(name, value)
                    for name, value in HEADERS.items():
                        self.send_header(name, value)
                    self.end_headers()
                    if "html" in answer.getheader("Content-Type", ""):
                        self.wfile.write(FOREIGN_LINK.sub(b"", answer.read()))
                        return
                    while block := answer.read(BLOCK):
                        self.wfile.write(block)

            def log_message(self, format: str, *words: object) -> None:
                pass

        self._server = ThreadingHTTPServer((LOOPBACK, 0), Handler)
        self._server.daemon_threads = True
        self.port = int(self._server.server_address[1])
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def __enter__(self) -> PageServer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
