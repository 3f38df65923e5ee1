"""The gate of the view: the address with its token opens the page, all else gets nothing and disturbs nothing."""

from __future__ import annotations

import asyncio
import ipaddress
import socket
import threading
from collections.abc import Iterator
from http.client import HTTPConnection
from types import ModuleType
from urllib.parse import urlsplit

import pytest
from websockets.asyncio.server import serve
from websockets.datastructures import Headers
from websockets.exceptions import InvalidStatus
from websockets.http11 import Response
from websockets.sync.client import connect

from gz_course.sim.gz.view import gate as gate_module
from gz_course.sim.gz.view.gate import Gate, OwnSocket, StudioChanged, check, install, user_of_peer

PAGE = (
    b"<html><head><title>MuJoCo Web Viewer</title></head>"
    b'<body><canvas id="canvas" oncontextmenu="x"></canvas></body></html>'
)
DEADLINE = 60


class FakeStudio(ModuleType):
    """What the gate knows of Studio's `web_server`: it binds by two functions, and serves by a third."""

    bind_public_socket = bind_loopback_socket = None
    serve = staticmethod(serve)

    def bind(self) -> None:
        self.public = self.bind_public_socket("::", 8080)
        self.bind_loopback_socket().close()

    def run(self) -> None:
        async def echo(connection):
            await connection.send(connection.request.path)

        def process_request(connection, request):
            if request.path.startswith("/state"):
                return None
            headers = Headers({"Access-Control-Allow-Origin": "*", "Content-Length": str(len(PAGE))})
            return Response(200, "OK", headers, PAGE)

        async def main() -> None:
            async with self.serve(echo, sock=self.public, process_request=process_request, process_response=None):
                self.stop = asyncio.Event()
                self.loop = asyncio.get_running_loop()
                await self.stop.wait()

        asyncio.run(main())


@pytest.fixture(scope="module")
def gate() -> Iterator[Gate]:
    studio = FakeStudio("studio")
    made = Gate(title="<room>")
    install(made, studio)
    studio.bind()
    thread = threading.Thread(target=studio.run, daemon=True)
    thread.start()
    check(made, DEADLINE)
    yield made
    studio.loop.call_soon_threadsafe(studio.stop.set)
    thread.join(DEADLINE)


def get(gate: Gate, path: str, **headers: str):
    connection = HTTPConnection("127.0.0.1", gate.port, timeout=DEADLINE)
    connection.request("GET", path, headers=headers)
    response = connection.getresponse()
    body = response.read()
    connection.close()
    return response, body


def token(gate: Gate) -> str:
    return urlsplit(gate.address).path.strip("/")


def test_it_listens_on_loopback_unless_told_otherwise(gate: Gate) -> None:
    assert ipaddress.ip_address(gate.socket.getsockname()[0]).is_loopback
    everywhere = Gate("0.0.0.0")
    assert everywhere.socket.getsockname()[0] == "0.0.0.0"
    assert urlsplit(everywhere.address).hostname not in ("0.0.0.0", "", None)
    everywhere.socket.close()
    with pytest.raises(OSError):
        Gate("192.0.2.1")


def test_whoever_comes_before_studio_accepts_waits_for_it() -> None:
    studio = FakeStudio("studio")
    studio.serve = lambda handler, **options: None  # it has not begun yet
    made = Gate()
    install(made, studio)
    studio.bind()
    studio.serve(None, sock=studio.public, process_request=lambda *_: None)
    check(made, DEADLINE)
    socket.create_connection(("127.0.0.1", made.port), DEADLINE).close()
    made.socket.close()


def test_the_address_opens_the_page(gate: Gate) -> None:
    response, body = get(gate, urlsplit(gate.address).path)
    assert response.status == 200
    assert b"<title>&lt;room&gt;</title>" in body
    assert b'<main><h1 class="heard">&lt;room&gt;</h1><canvas id="canvas" role="application"' in body
    assert b'oncontextmenu="x"></canvas>' in body and b'role="status"' in body
    assert b"window.WebSocket" in body and int(response.headers["Content-Length"]) == len(body)
    assert "frame-ancestors 'self' http://localhost:*" in response.headers["Content-Security-Policy"]
    assert response.headers.get_all("Cross-Origin-Embedder-Policy") == ["require-corp"]
    assert "Access-Control-Allow-Origin" not in response.headers
    assert get(gate, f"/{token(gate)}")[0].headers["Location"] == f"/{token(gate)}/"


@pytest.mark.parametrize(
    "path", ["/", "/model", "/state", "/nonsense/", "//", "/open/", "/open/nonsense", "/%00/", "/../model"]
)
def test_without_the_token_there_is_nothing(gate: Gate, path: str) -> None:
    response, body = get(gate, path)
    assert response.status in (400, 403)
    assert PAGE[:6] not in body and token(gate).encode() not in body


def test_nothing_can_be_dropped(gate: Gate) -> None:
    assert get(gate, f"/{token(gate)}/drop")[0].status == 403


def test_a_websocket_opens_for_the_page_itself_only(gate: Gate) -> None:
    here, path = f"127.0.0.1:{gate.port}", f"/{token(gate)}/state?sid=1"
    with connect(f"ws://{here}{path}", origin=f"http://{here}") as opened:
        assert opened.recv(DEADLINE) == "/state?sid=1"
    proxied = {"X-Forwarded-Host": "hub.example"}
    with connect(f"ws://{here}{path}", origin="https://hub.example", additional_headers=proxied) as opened:
        assert opened.recv(DEADLINE) == "/state?sid=1"
    for address, origin in [
        (f"ws://{here}{path}", "http://evil.example"),
        (f"ws://{here}{path}", "null"),
        (f"ws://{here}/state?sid=1", f"http://{here}"),
        (f"ws://{here}/wrong/state?sid=1", f"http://{here}"),
    ]:
        with pytest.raises(InvalidStatus, match="403"):
            connect(address, origin=origin)


@pytest.mark.parametrize("count", [100, pytest.param(1000, marks=pytest.mark.proof)])
def test_many_connections_disturb_nothing(gate: Gate, count: int) -> None:
    idle = [socket.create_connection(("127.0.0.1", gate.port), DEADLINE) for _ in range(count)]
    assert get(gate, urlsplit(gate.address).path)[0].status == 200
    ended = 0
    for each in idle[: count - gate_module._MOST_WAITING]:
        try:
            ended += each.recv(1) == b""
        except ConnectionResetError:
            ended += 1
    for each in idle:
        each.close()
    assert ended == count - gate_module._MOST_WAITING


def test_the_address_for_the_browser_works_once_and_for_this_user(gate: Gate, monkeypatch: pytest.MonkeyPatch) -> None:
    path = urlsplit(gate.address_for_browser()).path
    monkeypatch.setattr(gate_module, "user_of_peer", lambda connection: 4_000_000)
    assert get(gate, path)[0].status == 403, "somebody else's browser"
    monkeypatch.undo()
    assert get(gate, path)[0].headers["Location"] == f"/{token(gate)}/"
    assert get(gate, path)[0].status == 403
    late = urlsplit(gate.address_for_browser()).path
    monkeypatch.setattr(gate_module, "_ONCE_S", -1.0)
    late = urlsplit(gate.address_for_browser()).path
    assert get(gate, late)[0].status == 403


def test_the_port_of_the_panels_is_for_this_user(monkeypatch: pytest.MonkeyPatch) -> None:
    import os

    with OwnSocket(socket.AF_INET, socket.SOCK_STREAM) as listening:
        listening.bind(("127.0.0.1", 0))
        listening.listen()
        with socket.create_connection(listening.getsockname()) as mine:
            accepted, _ = listening.accept()
            assert user_of_peer(accepted) == user_of_peer(mine) == os.getuid()
            accepted.close()
        monkeypatch.setattr(gate_module, "user_of_peer", lambda connection: 4_000_000)
        with socket.create_connection(listening.getsockname()), pytest.raises(ConnectionAbortedError):
            listening.accept()


def test_another_studio_is_refused_aloud() -> None:
    with Gate().socket as bound:
        made = Gate.__new__(Gate)
        made.socket, made.used, made.serving = bound, set(), threading.Event()
        studio = ModuleType("studio")
        with pytest.raises(StudioChanged, match="no 'bind_public_socket'"):
            install(made, studio)
        studio = FakeStudio("studio")
        install(made, studio)
        with pytest.raises(StudioChanged, match="socket"):
            check(made, 0.0)
        with socket.socket() as own, pytest.raises(StudioChanged, match="not with the filter"):
            studio.serve(None, sock=own, process_request=None)
