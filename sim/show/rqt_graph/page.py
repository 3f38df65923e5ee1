"""The picture in a browser of this machine: a page that asks for the next picture and gets it when it has changed."""

from __future__ import annotations

import contextlib
import secrets
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import TracebackType
from urllib.parse import urlsplit

LOOPBACK = "127.0.0.1"
_WAIT_S = 20.0  # [s] after which a request that waits for a change is answered with what there is
_HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; connect-src 'self'; "
        "frame-ancestors 'self' http://localhost:* http://127.0.0.1:*"
    ),
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}
_PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Node graph</title>
<style>body{margin:0;background:#fff;font:14px sans-serif}#gone{display:none;color:#c62828;padding:8px 20px}
svg{max-width:100%;height:auto}</style></head>
<body><div id="gone">The program that draws this picture has ended.</div><main id="graph"></main>
<script>
(async () => {
  const graph = document.getElementById("graph"), gone = document.getElementById("gone");
  let seen = "";
  for (;;) {
    try {
      const answer = await fetch("graph.svg?after=" + seen);
      const text = await answer.text();
      if (answer.ok && answer.headers.get("ETag") !== seen) {
        seen = answer.headers.get("ETag");
        graph.innerHTML = text;
      }
      gone.style.display = "none";
    } catch {
      gone.style.display = "block";
      await new Promise((done) => setTimeout(done, 1000));
    }
  }
})();
</script></body></html>
"""


class Page:
    """Serves the last picture at an address that cannot be guessed, until its `with` block ends."""

    def __init__(self) -> None:
        self._changed = threading.Condition()
        self._svg = ""
        self._number = 0
        self._ended = False
        start = f"/{secrets.token_urlsafe(16)}/"
        page = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                asked = urlsplit(self.path)
                if asked.path == start:
                    self._answer(_PAGE, "text/html; charset=utf-8", "page")
                elif asked.path == f"{start}graph.svg":
                    self._answer(*page.after(asked.query.removeprefix("after=")))
                else:
                    self.send_error(404)

            def _answer(self, text: str, kind: str, tag: str) -> None:
                content = text.encode()
                with contextlib.suppress(ConnectionError):  # the page was closed meanwhile
                    self.send_response(200)
                    for name, value in {**_HEADERS, "Content-Type": kind, "ETag": tag}.items():
                        self.send_header(name, value)
                    self.send_header("Content-Length", str(len(content)))
                    self.end_headers()
                    self.wfile.write(content)

            def log_message(self, format: str, *words: object) -> None:
                pass

        self._server = ThreadingHTTPServer((LOOPBACK, 0), Handler)
        self._server.daemon_threads = True
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)
        self._thread.start()
        self.address = f"http://{LOOPBACK}:{self._server.server_address[1]}{start}"

    def show(self, svg: str) -> None:
        """Show another picture; pages that wait for a change get it at once."""
        with self._changed:
            if svg != self._svg:
                self._svg = svg
                self._number += 1
                self._changed.notify_all()

    def after(self, seen: str) -> tuple[str, str, str]:
        """Return the picture, its type and its number as soon as the number is another one than `seen`."""
        with self._changed:
            self._changed.wait_for(lambda: self._ended or str(self._number) != seen, _WAIT_S)
            return self._svg, "image/svg+xml; charset=utf-8", str(self._number)

    def __enter__(self) -> Page:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._changed:
            self._ended = True
            self._changed.notify_all()
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()
