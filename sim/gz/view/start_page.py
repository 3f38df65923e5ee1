"""The page on which `gz sim` without a world has one chosen.

It is served by this process, on loopback unless another address is asked for, to this user only, and below a token.
When a world was chosen the page waits for the view and goes there.

Source: https://developer.mozilla.org/docs/Web/HTTP/Guides/CSP
"""

from __future__ import annotations

import hmac
import html
import secrets
import socket
import threading
import webbrowser
from collections.abc import Mapping
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from types import TracebackType
from urllib.parse import parse_qs

from gz_course.sim.gz.view.gate import OwnSocket
from gz_course.sim.gz.view.view_process import has_desktop
from gz_course.sim.jupyter_proxy import reachable

_POLICY = (
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; connect-src 'self'; "
    "form-action 'self'; base-uri 'none'; frame-ancestors 'none'"
)
_MOST_BYTES = 4096
_STYLE = """body{font:16px sans-serif;max-width:46em;margin:2em auto;padding:0 1em;color:#222;background:#fff}
h1{font-size:1.4em}li{list-style:none;margin:.5em 0;display:flex;flex-wrap:wrap;gap:.2em 1em;align-items:center}
ul{padding:0}button{font:inherit;width:17em;padding:.4em .8em;text-align:left;border:1px solid #777;border-radius:.3em;
background:#f2f5f8;color:#123;cursor:pointer}span{flex:1 1 14em;color:#444}"""
_WAITING = """<p id="said" role="status">The world {0} is being loaded; its view opens here.</p>
<script>
async function look() {{
  try {{
    const answer = await fetch("view");
    if (answer.status === 200) {{ location.replace(await answer.text()); return; }}
    setTimeout(look, 300);
  }} catch (error) {{ document.getElementById("said").textContent = "gz sim has ended; its terminal says why."; }}
}}
look();
</script>"""


class StartPage:
    """A page that offers worlds by name, each with a line about it; `address` is what a browser needs."""

    def __init__(self, worlds: Mapping[str, str], *, bind: str = "127.0.0.1", port: int = 0) -> None:
        """Serve the page. Raises OSError if the address does not belong to this machine or the port is taken."""
        self._worlds = dict(worlds)
        self._token, self._once = secrets.token_urlsafe(24), secrets.token_urlsafe(24)
        self._chosen, self._view = "", ""
        self._changed = threading.Event()
        page = self

        class Handler(_Handler):
            start_page = page

        class Server(ThreadingHTTPServer):
            address_family = socket.AF_INET6 if ":" in bind else socket.AF_INET
            daemon_threads = True

        self._server = Server((bind, port), Handler, bind_and_activate=False)
        self._server.socket.close()
        self._server.socket = OwnSocket(Server.address_family, socket.SOCK_STREAM)
        self._server.allow_reuse_address = True
        try:
            self._server.server_bind()
            self._server.server_activate()
        except OSError:
            self._server.server_close()
            raise
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)
        self._thread.start()

    @property
    def address(self) -> str:
        return reachable(f"{self._origin}/{self._token}/")

    @property
    def _origin(self) -> str:
        host, port = self._server.server_address[:2]
        shown = socket.getfqdn() if host in ("0.0.0.0", "::") else str(host)
        return f"http://[{shown}]:{port}" if ":" in shown else f"http://{shown}:{port}"

    def open_browser(self) -> bool:
        """Open the page in the browser of the desktop, by an address that works once; return False if there is none."""
        return has_desktop() and webbrowser.open(f"{self._origin}/{self._once}/", new=2)

    def wait(self, stop: threading.Event) -> str:
        """Return the name of the world that was chosen; empty if `stop` is set first."""
        while not self._changed.wait(0.1):
            if stop.is_set():
                return ""
        return self._chosen

    def lead_to(self, address: str) -> None:
        """Have the page go to the view."""
        self._view = address

    def choose(self, name: str) -> bool:
        """Take the answer of the page; return False for a name that it does not offer."""
        if name in self._worlds and not self._chosen:
            self._chosen = name
            self._changed.set()
        return name in self._worlds

    def answer(self, token: str, rest: str) -> tuple[HTTPStatus, str]:
        """Return status and text for a GET below a token: the page, the address of the view, or where the page is."""
        if token and secrets.compare_digest(token.encode(), self._once.encode()):
            self._once = secrets.token_urlsafe(24)
            return HTTPStatus.FOUND, f"/{self._token}/"
        if not self.knows(token):
            return HTTPStatus.FORBIDDEN, "This page opens with the whole address that gz sim has printed.\n"
        if rest == "view":
            return (HTTPStatus.OK, self._view) if self._view else (HTTPStatus.NO_CONTENT, "")
        return HTTPStatus.OK, self._page(_WAITING.format(html.escape(self._chosen)) if self._chosen else self._offer())

    def knows(self, token: str) -> bool:
        return hmac.compare_digest(token.encode(), self._token.encode())

    def _offer(self) -> str:
        lines = "".join(
            f'<li><button name="world" value="{html.escape(name)}">{html.escape(name)}</button>'
            f"<span>{html.escape(line)}</span></li>"
            for name, line in self._worlds.items()
        )
        return f'<form method="post" action="start"><ul>{lines}</ul></form>'

    def _page(self, body: str) -> str:
        return (
            f'<!doctype html><html lang="en"><meta charset="utf-8"><title>gz sim: choose a world</title>'
            f"<style>{_STYLE}</style><main><h1>Choose a world</h1>{body}</main></html>"
        )

    def close(self) -> None:
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def __enter__(self) -> StartPage:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class _Handler(BaseHTTPRequestHandler):
    start_page: StartPage
    timeout = 10.0
    """Time [s] in which a connection has to ask."""

    def do_GET(self) -> None:
        _, token, *rest = [*self.path.split("/", 2), ""]
        status, text = self.start_page.answer(token, rest[0])
        self._send(status, text)

    def do_POST(self) -> None:
        _, token, *rest = [*self.path.split("/", 2), ""]
        length = self.headers.get("Content-Length", "")
        origin = self.headers.get("Origin")
        # A proxy that asks under its own name puts that of the page into X-Forwarded-Host, which no page can set.
        hosts = {self.headers.get("Host"), self.headers.get("X-Forwarded-Host")}
        foreign = origin is not None and origin.partition("://")[2] not in hosts
        if not self.start_page.knows(token) or rest[0] != "start" or foreign:
            self._send(HTTPStatus.FORBIDDEN, "This page opens with the whole address that gz sim has printed.\n")
        elif not length.isdigit() or int(length) > _MOST_BYTES:
            self._send(HTTPStatus.BAD_REQUEST, "expected the name of a world\n")
        else:
            names = parse_qs(self.rfile.read(int(length)).decode("utf-8", "replace")).get("world", [""])
            known = self.start_page.choose(names[0])
            self._send(*((HTTPStatus.SEE_OTHER, "./") if known else (HTTPStatus.BAD_REQUEST, "no such world\n")))

    def _send(self, status: HTTPStatus, text: str) -> None:
        body = b"" if status in (HTTPStatus.FOUND, HTTPStatus.SEE_OTHER) else text.encode()
        self.send_response(status)
        if status in (HTTPStatus.FOUND, HTTPStatus.SEE_OTHER):
            self.send_header("Location", text)
        kind = "text/html" if text.startswith("<!doctype") else "text/plain"
        for name, value in (
            ("Content-Type", f"{kind}; charset=utf-8"),
            ("Content-Length", str(len(body))),
            ("Content-Security-Policy", _POLICY),
            ("Cache-Control", "no-store"),
            ("Referrer-Policy", "no-referrer"),
            ("X-Content-Type-Options", "nosniff"),
        ):
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *args: object) -> None:
        """Print nothing: the terminal belongs to gz sim."""
