"""The view in a real browser: what is seen moves, and what is clicked has its effect on the world."""

from __future__ import annotations

import io
import os
import re
import signal
import socket
import subprocess
import sys
import threading
import uuid
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import pytest
from PIL import Image

from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.entity_factory_pb2 import EntityFactory
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.msgs.world_stats_pb2 import WorldStatistics
from gz_course.sim.gz.transport import Node
from gz_course.tests.browser import DEADLINE, ELSEWHERE, TRY, chromium, eventually, needs_chromium, watched_chromium

SIZE = {"width": 800, "height": 480}
USER = "/user/alice/"
PLAY, STEP, RESET = (45, 20), (107, 20), (238, 20)
MAGENTA = """<sdf version='1.10'><model name='sign'><static>true</static><link name='l'><visual name='v'>
<geometry><box><size>1 1 1</size></box></geometry><material><diffuse>1 0 1 1</diffuse></material></visual></link>
</model></sdf>"""

pytestmark = [
    pytest.mark.proof,
    pytest.mark.timeout(1800),
    needs_chromium,
]


@pytest.fixture
def gz(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., tuple[subprocess.Popen[str], str]]]:
    """Start `gz sim` and return it with the address of its view."""
    monkeypatch.setenv("GZ_IP", "127.0.0.1")
    monkeypatch.setenv("GZ_PARTITION", uuid.uuid4().hex)
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    started: list[subprocess.Popen[str]] = []

    def start(*words: str) -> tuple[subprocess.Popen[str], str]:
        program = str(Path(sys.executable).with_name("gz"))
        process = subprocess.Popen([program, "sim", *words], stderr=subprocess.PIPE, text=True, start_new_session=True)
        started.append(process)
        assert process.stderr is not None
        for line in process.stderr:
            if found := re.search(r"see world '\w+' at (\S+)", line):
                return process, found[1]
        raise AssertionError("no address was said")

    yield start
    for process in started:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate(timeout=DEADLINE)


@pytest.fixture
def hub(tmp_path: Path) -> Iterator[str]:
    """A Jupyter server as JupyterHub starts it for a user, with jupyter-server-proxy; its host and port."""
    pytest.importorskip("jupyter_server_proxy")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    options = ["--no-browser", "--allow-root", f"--port={port}", "--ip=127.0.0.1", f"--ServerApp.root_dir={tmp_path}"]
    options += [f"--ServerApp.base_url={USER}", "--IdentityProvider.token=", "--ServerApp.port_retries=0"]
    homes = {name: str(tmp_path) for name in ("HOME", "JUPYTER_DATA_DIR", "JUPYTER_CONFIG_DIR", "JUPYTER_RUNTIME_DIR")}
    log = tmp_path / "jupyter.log"
    with log.open("wb") as output:
        server = subprocess.Popen(
            [sys.executable, "-m", "jupyter", "server", *options],
            stderr=output,
            env=os.environ | homes,
            start_new_session=True,
        )
    try:
        eventually(lambda: "is running at" in log.read_text() or server.poll() is not None, "Jupyter listens")
        assert server.poll() is None, log.read_text()
        yield f"localhost:{port}"
    finally:
        os.killpg(server.pid, signal.SIGKILL)
        server.wait(DEADLINE)


@pytest.fixture
def browser() -> Iterator[Any]:
    with chromium() as running:
        yield running


class Seen:
    """A page, and what can be seen on it."""

    def __init__(self, browser: Any, address: str, **wishes: str) -> None:
        self.page = browser.new_page(viewport=SIZE, **wishes)
        self.page.set_default_timeout(DEADLINE * 1000)
        self.page.goto(address)

    def picture(self) -> np.ndarray:
        """Return the middle of the page, without the panels, as RGB numbers."""
        shot = Image.open(io.BytesIO(self.page.screenshot())).convert("RGB")
        return np.asarray(shot.crop((255, 45, SIZE["width"] - 325, SIZE["height"] - 70))).astype(int)

    def where(self, channels: Callable[[Any, Any, Any], Any]) -> np.ndarray:
        """Return the middle of the pixels of a colour, empty if there are few."""
        found = np.argwhere(channels(*np.moveaxis(self.picture(), 2, 0)))
        return found.mean(axis=0) if len(found) >= 8 else np.zeros(0)


def green_at(page: Any, place: tuple[int, int]) -> bool:
    """Tell whether something green is drawn beside this place [pixels]."""
    shot = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    x, y = place
    r, g, b = np.asarray(shot.crop((x - 40, y - 8, x + 40, y + 8))).astype(int).reshape(-1, 3).mean(axis=0)
    return bool(g > r + 30 and g > b + 30)


def blue(r: Any, g: Any, b: Any) -> Any:
    return (b > r + 50) & (b > g + 40)


def magenta(r: Any, g: Any, b: Any) -> Any:
    return (r > g + 70) & (b > g + 70)


def test_the_world_is_seen_and_obeys(gz: Callable[..., tuple[subprocess.Popen[str], str]], browser: Any) -> None:
    process, address = gz("lidar_room.sdf")
    seen = Seen(browser, address)
    eventually(lambda: len(seen.where(blue)), "the robot is drawn")
    with Node() as node:
        stats: list[Any] = [WorldStatistics()]
        node.subscribe(WorldStatistics, "/stats", lambda message: stats.append(message))
        eventually(lambda: stats[-1].paused, "the world waits")
        seen.page.mouse.click(*STEP, delay=500)
        eventually(lambda: stats[-1].iterations == 1 and stats[-1].paused, "Step runs one step")
        seen.page.mouse.click(*PLAY, delay=500)
        eventually(lambda: not stats[-1].paused and stats[-1].iterations > 100, "Play lets it run")

        start = seen.where(blue)
        wheels = node.advertise("/model/robot/cmd_vel", Twist)
        assert wheels.wait_for_subscribers(1, DEADLINE)
        forward: Any = Twist()
        forward.linear.x = 0.5
        wheels.publish(forward)
        eventually(
            lambda: len(now := seen.where(blue)) and np.linalg.norm(now - start) > 15.0,
            "the robot moves in the picture",
        )
        request: Any = EntityFactory(sdf=MAGENTA)
        request.pose.position.z = 0.5
        assert node.request("/world/lidar_room/create", request, EntityFactory, Boolean, int(DEADLINE * 1000))[0]
        eventually(lambda: len(seen.where(magenta)), "a model that comes is seen")

        seen.page.mouse.click(*PLAY, delay=500)
        eventually(lambda: stats[-1].paused, "Pause stops it")
        seen.page.mouse.click(*RESET, delay=500)
        eventually(lambda: stats[-1].iterations == 0 and stats[-1].paused, "Reset starts again")
        eventually(lambda: not len(seen.where(magenta)), "what came after the start has gone")

    views = psutil.Process(process.pid).children(recursive=True)
    process.send_signal(signal.SIGINT)
    assert process.wait(DEADLINE) == 0
    assert psutil.wait_procs(views, DEADLINE)[1] == [], "Ctrl-C ends both"


def test_a_notebook_may_frame_the_page_and_a_stranger_may_not(
    gz: Callable[..., tuple[subprocess.Popen[str], str]], browser: Any
) -> None:
    from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

    _, address = gz("empty.sdf")

    class Notebook(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(f'<iframe src="{address}" width=760 height=440></iframe>'.encode())

        def log_message(self, *_: object) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Notebook)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    page = browser.new_page(viewport=SIZE)
    page.set_default_timeout(DEADLINE * 1000)
    said: list[str] = []
    page.on("console", lambda message: said.append(message.text))
    page.goto(f"http://localhost:{server.server_address[1]}/")
    connected = "State WebSocket connected"
    eventually(lambda: page.wait_for_timeout(50) or any(connected in each for each in said), "a live frame")
    page.close()

    stranger = browser.new_page(viewport=SIZE)
    stranger.route(
        "http://evil.example/", lambda r: r.fulfill(body=f'<iframe src="{address}"></iframe>', content_type="text/html")
    )
    stranger.goto("http://evil.example/")
    stranger.wait_for_load_state()
    framed = [frame.url for frame in stranger.frames[1:]]
    assert not any(each.startswith("http") for each in framed), framed
    tried = stranger.evaluate(
        "(address) => new Promise((done) => { const s = new WebSocket(address.replace('http', 'ws') + 'state?sid=1');"
        " s.onopen = () => done('open'); s.onerror = () => done('refused'); })",
        address,
    )
    assert tried == "refused", "even with the token"
    server.shutdown()
    server.server_close()


def test_the_page_asks_no_other_machine(gz: Callable[..., tuple[subprocess.Popen[str], str]]) -> None:
    _, address = gz("empty.sdf")
    with watched_chromium() as (browser, outside):
        page = browser.new_page(viewport=SIZE)
        page.set_default_timeout(DEADLINE * 1000)
        said: list[str] = []
        page.on("console", lambda message: said.append(message.text))
        page.goto(address)
        eventually(
            lambda: page.wait_for_timeout(50) or any("State WebSocket connected" in x for x in said), "the world"
        )
        assert page.title() == "empty" and page.locator("html").get_attribute("lang") == "en"
        page.evaluate(TRY)
        assert outside.asked == set()
        refused = [each for each in said if ELSEWHERE in each and "Content Security Policy" in each]
        assert refused, "what the page tried was kept back by its policy"


def test_the_world_is_heard_and_obeys_keys(gz: Callable[..., tuple[subprocess.Popen[str], str]], browser: Any) -> None:
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    _, address = gz("empty.sdf")
    page = Seen(browser, address, reduced_motion="reduce").page
    heard = page.locator("[role=status]")

    def says(words: str) -> None:
        eventually(lambda: page.wait_for_timeout(50) or words in heard.text_content(), f"the page says {words}")

    says("World empty, paused.")
    eventually(lambda: green_at(page, PLAY), "the button Play is drawn")
    page.keyboard.press("Space", delay=500)
    says("World empty, running.")
    page.keyboard.press("n", delay=500)
    says("Step: pause the world first, with Space.")
    page.keyboard.press("Space", delay=500)
    says("World empty, paused.")
    page.keyboard.press("F2", delay=500)
    says("Panel World control")
    page.keyboard.press("Escape", delay=500)
    says("The keys are those of the world again.")
    assert "Simulated time" in page.locator("#whole").text_content()
    assert page.locator("li", has_text="Backspace: reset the world").count() == 1
    focused = []
    for _ in range(2):
        page.keyboard.press("Tab")
        focused.append(page.evaluate("document.activeElement.id"))
    assert focused == ["canvas", ""], "Tab leads to the picture and out of the page"
    found = axe.run(page)
    assert found.response["violations"] == [], found.generate_report()


def test_behind_jupyter_server_proxy_the_world_is_seen_and_obeys(
    gz: Callable[..., tuple[subprocess.Popen[str], str]], hub: str, browser: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("JUPYTERHUB_SERVICE_PREFIX", USER)
    _, address = gz("lidar_room.sdf")
    assert re.fullmatch(rf"{USER}proxy/\d+/[\w-]{{32}}/", address)
    seen = Seen(browser, f"http://{hub}{address}")
    eventually(lambda: len(seen.where(blue)), "the robot is drawn")
    with Node() as node:
        stats: list[Any] = [WorldStatistics()]
        node.subscribe(WorldStatistics, "/stats", lambda message: stats.append(message))
        eventually(lambda: stats[-1].paused, "the world waits")
        seen.page.mouse.click(*STEP, delay=500)
        eventually(lambda: stats[-1].iterations == 1, "Step runs one step")
