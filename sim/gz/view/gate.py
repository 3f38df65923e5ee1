"""The gate in front of Studio's web server: one address, a token in it, and nothing for anybody else.

Studio listens on all interfaces and serves whoever asks. Here it gets a socket that is bound already (loopback unless
another address is asked for), and every request passes `Gate.answer` first. All paths begin with the token; the script
of `page.py` makes the page ask below that path. So no cookie is needed, which a browser would send to other ports of
this machine and refuse to a page in a frame.

Studio has no hook for this: `install` replaces `bind_public_socket`, `bind_loopback_socket` and `serve` in its module
`web_server`, and raises StudioChanged if a later version has no such names or does not use them.

Source: mujoco.studio.web.web_server of mujoco-studio 4.0.0
Source: https://developer.mozilla.org/docs/Web/HTTP/Reference/Headers/Content-Security-Policy/frame-ancestors
Source: https://wicg.github.io/document-isolation-policy/ (SharedArrayBuffer in a frame of a page that is not isolated)
"""

from __future__ import annotations

import functools
import hmac
import os
import secrets
import socket
import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from http import HTTPStatus
from pathlib import Path
from types import ModuleType
from typing import Any
from urllib.parse import urlsplit

from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.frames import Frame, Opcode
from websockets.http11 import Request, Response

from gz_course.sim.gz.view.page import STILL, TOLD, furnished
from gz_course.sim.page_policy import policy

_MOST_WAITING = 64
"""Connections that may be open without having asked for anything; the oldest ends when there is one more."""
_REQUEST_S = 10.0
"""Time [s] in which a connection has to ask."""
_MOST_AHEAD = 2
"""Pictures that may be sent before the browser has drawn one."""
_PICTURE_S = 0.5
"""Time [s] after which the next picture is sent anyway."""
_MOST_BYTES = 1 << 20
"""Size [B] of the largest message that a page may send; pages send keys and mouse positions."""
_ONCE_S = 120.0
"""Time [s] for which the address for the browser is valid; it works once."""
_FRAMED_BY = "'self' http://localhost:* http://127.0.0.1:* https://localhost:* vscode-webview:"
"""Pages that may show the view in a frame: notebooks of this machine."""
_HEADERS = {
    "Access-Control-Allow-Origin": "",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Embedder-Policy": "require-corp",
    "Cross-Origin-Resource-Policy": "cross-origin",
    "Content-Security-Policy": policy("", f"frame-ancestors {_FRAMED_BY}"),
    "Document-Isolation-Policy": "isolate-and-require-corp",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}
"""Headers of all answers; an empty one is taken out."""


class StudioChanged(RuntimeError):
    """The installed MuJoCo Studio cannot be guarded, so it is not started."""


class Gate:
    """A bound socket with a token; `address` is what a browser needs."""

    def __init__(self, bind: str = "127.0.0.1", port: int = 0, title: str = "gz sim") -> None:
        """Bind a socket. Raises OSError if the address does not belong to this machine or the port is taken."""
        self.title = title
        self.tell: Callable[[bool], str] = lambda still: "{}"
        """What the page reads aloud, as JSON; it is told whether the reader wants motion reduced."""
        family = socket.AF_INET6 if ":" in bind else socket.AF_INET
        self.socket = socket.socket(family, socket.SOCK_STREAM)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            self.socket.bind((bind, port))
        except OSError:
            self.socket.close()
            raise
        self._token = secrets.token_urlsafe(24)
        self._once: tuple[str, float] | None = None
        self._waiting: OrderedDict[Any, None] = OrderedDict()
        self._drawn = 0
        self._drawing = threading.Condition()
        self.serving = threading.Event()
        """Set when Studio serves through this gate."""
        self.used: set[str] = set()
        """What Studio has taken from `install`."""

    @property
    def port(self) -> int:
        return int(self.socket.getsockname()[1])

    @property
    def _origin(self) -> str:
        host = str(self.socket.getsockname()[0])
        if host in ("0.0.0.0", "::"):
            host = socket.getfqdn()
        return f"http://[{host}]:{self.port}" if ":" in host else f"http://{host}:{self.port}"

    @property
    def address(self) -> str:
        """Return the address of the page, token included."""
        return f"{self._origin}/{self._token}/"

    def address_for_browser(self) -> str:
        """Return an address that works once, soon, and for processes of this user only.

        The command line of a browser can be read by everybody on this machine, so the token must not stand in it.
        """
        code = secrets.token_urlsafe(24)
        self._once = code, time.monotonic() + _ONCE_S
        return f"{self._origin}/open/{code}"

    def answer(self, studio: Any, connection: Any, request: Request) -> Response | None:
        """Answer a request, or let Studio do it: None lets a WebSocket open, as `process_request` of websockets."""
        path, _, query = request.path.partition("?")
        _, token, *rest = path.split("/", 2)
        if token == "open" and rest and self._takes(rest[0], connection):
            return _response(HTTPStatus.FOUND, "", {"Location": f"/{self._token}/", "Referrer-Policy": "no-referrer"})
        if not hmac.compare_digest(token.encode(), self._token.encode()):
            return _response(HTTPStatus.FORBIDDEN, "This page opens with the whole address that gz sim has printed.\n")
        if not rest:
            return _response(HTTPStatus.FOUND, "", {"Location": f"/{self._token}/"})
        origin = request.headers.get("Origin")
        # A proxy that asks under its own name puts that of the page into X-Forwarded-Host, which no page can set.
        hosts = {request.headers.get("Host"), request.headers.get("X-Forwarded-Host")}
        if origin is not None and urlsplit(origin).netloc not in hosts:
            return _response(HTTPStatus.FORBIDDEN, "Another page asks for this one.\n")
        if rest[0] == "drop":
            return _response(HTTPStatus.FORBIDDEN, "Models come into a world with the panel Resource Spawner.\n")
        if rest[0] == TOLD:
            return _response(HTTPStatus.OK, self.tell(query == STILL), {"Cache-Control": "no-store"})
        request.path = f"/{rest[0]}" + (f"?{query}" if query else "")
        response: Response | None = studio(connection, request)
        self._waiting.pop(connection, None)
        if response is not None and response.status_code == HTTPStatus.OK and rest[0] in ("", "index.html"):
            self._furnish(response)
        return response

    def _takes(self, code: str, connection: Any) -> bool:
        """Return whether `code` is the one for the browser, from this user, in time and for the first time."""
        known, until = self._once or ("", 0.0)
        if not known or not hmac.compare_digest(code.encode(), known.encode()):
            return False
        if time.monotonic() > until or user_of_peer(connection.transport.get_extra_info("socket")) not in (
            None,
            os.getuid(),
        ):
            return False
        self._once = None
        return True

    def _furnish(self, page: Response) -> None:
        """Put what `page.py` adds into Studio's page."""
        try:
            text = furnished(page.body.decode(), self.title)
        except ValueError as error:
            raise StudioChanged(str(error)) from None
        page.body = text.encode()
        del page.headers["Content-Length"]
        page.headers["Content-Length"] = str(len(page.body))

    def seal(self, connection: Any, request: Request, response: Response) -> None:
        """Set the headers of every answer, as `process_response` of websockets."""
        for name, value in _HEADERS.items():
            if name in response.headers:
                del response.headers[name]
            if value:
                response.headers[name] = value

    def drawn(self) -> None:
        """Note that the browser in control has drawn a picture: it sends its keys and mouse with each."""
        with self._drawing:
            self._drawn = min(self._drawn + 1, _MOST_AHEAD)
            self._drawing.notify_all()

    def wait_until_drawn(self) -> None:
        """Return when the browser has drawn the last picture but one, so that a slow one does not fall behind.

        Studio sends the panels 60 times a second, and a browser that draws less often shows them later and later.
        """
        with self._drawing:
            self._drawing.wait_for(lambda: self._drawn > 0, _PICTURE_S)
            self._drawn = max(0, self._drawn - 1)

    def came(self, connection: Any) -> None:
        """Count a new connection in; end the oldest one of too many that have not asked for anything."""
        self._waiting[connection] = None
        if len(self._waiting) > _MOST_WAITING:
            oldest, _ = self._waiting.popitem(last=False)
            oldest.transport.abort()

    def went(self, connection: Any) -> None:
        self._waiting.pop(connection, None)


def install(gate: Gate, web_server: ModuleType) -> None:
    """Make Studio's module serve through `gate`, in the whole process. Raises StudioChanged if it cannot be done."""
    missing = [n for n in ("bind_public_socket", "bind_loopback_socket", "serve") if not hasattr(web_server, n)]
    if missing:
        raise StudioChanged(f"mujoco.studio.web.web_server has no '{missing[0]}'; mujoco-studio 4.0.0 has it")
    plain_serve = web_server.serve

    class Connection(ServerConnection):
        def connection_made(self, transport: Any) -> None:
            super().connection_made(transport)
            gate.came(self)

        def process_event(self, event: Any) -> None:
            super().process_event(event)
            path = self.request.path if self.request is not None else ""
            if isinstance(event, Frame) and event.opcode is Opcode.BINARY and path.startswith("/ui"):
                gate.drawn()

        def connection_lost(self, exc: Exception | None) -> None:
            gate.went(self)
            super().connection_lost(exc)

    def serve(handler: Any, **options: Any) -> Any:
        if options.get("sock") is not gate.socket or not callable(options.get("process_request")):
            raise StudioChanged("MuJoCo Studio does not serve on the socket, or not with the filter, it was given")
        options["process_request"] = functools.partial(gate.answer, options["process_request"])
        options["process_response"] = gate.seal
        options.update(create_connection=Connection, open_timeout=_REQUEST_S, max_size=_MOST_BYTES)
        gate.socket.listen()  # who comes before Studio accepts waits for it
        gate.serving.set()
        return plain_serve(handler, **options)

    def bind_public_socket(host: str, port: int = 0) -> socket.socket:
        gate.used.add("public")
        return gate.socket

    def bind_loopback_socket(port: int = 0) -> socket.socket:
        gate.used.add("loopback")
        listening = OwnSocket(socket.AF_INET, socket.SOCK_STREAM)
        listening.bind(("127.0.0.1", port))
        listening.listen()
        return listening

    web_server.serve = serve  # type: ignore[attr-defined]
    web_server.bind_public_socket = bind_public_socket  # type: ignore[attr-defined]
    web_server.bind_loopback_socket = bind_loopback_socket  # type: ignore[attr-defined]


def check(gate: Gate, patience: float = 60.0) -> None:
    """Wait until Studio serves; raise StudioChanged if it does not use what `install` gave it."""
    if gate.used != {"public", "loopback"} or not gate.serving.wait(patience):
        raise StudioChanged("MuJoCo Studio does not serve through the guarded socket")


class OwnSocket(socket.socket):
    """A listening loopback socket that accepts this user's processes only."""

    def accept(self) -> tuple[socket.socket, Any]:
        """Accept a connection. Raises ConnectionAbortedError for one of another user; servers go on after it."""
        accepted, address = super().accept()
        if user_of_peer(accepted) not in (None, os.getuid()):
            accepted.close()
            raise ConnectionAbortedError("a process of another user")
        return accepted, address


def user_of_peer(connection: socket.socket) -> int | None:
    """Return the user id of the process at the other end of a loopback TCP connection; None if it is not known.

    Source: https://www.kernel.org/doc/html/latest/networking/proc_net_tcp.html
    """
    try:
        here, there = connection.getsockname()[1], connection.getpeername()[1]
        for table in ("/proc/net/tcp", "/proc/net/tcp6"):
            for line in Path(table).read_text().splitlines()[1:]:
                fields = line.split()
                ports = [int(fields[column].rpartition(":")[2], 16) for column in (1, 2)]
                if ports == [there, here]:
                    return int(fields[7])
    except (OSError, ValueError, IndexError):
        return None
    return None


def _response(status: HTTPStatus, text: str, headers: dict[str, str] | None = None) -> Response:
    body = text.encode()
    given = {"Content-Type": "text/plain; charset=utf-8", "Content-Length": str(len(body)), "Connection": "close"}
    return Response(status.value, status.phrase, Headers({**given, **(headers or {})}), body)
