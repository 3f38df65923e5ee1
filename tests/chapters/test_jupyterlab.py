"""A chapter in a real JupyterLab: no question about news, no request elsewhere, the world beside the notebook."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import nbformat
import pytest

from gz_course.tests.browser import DEADLINE, eventually, needs_chromium, watched_chromium

pytestmark = [pytest.mark.proof, pytest.mark.timeout(1800), needs_chromium]
SIZE = {"width": 1400, "height": 900}
WATCH = """
import os, sys
def heard(event, arguments):
    if event == "socket.getaddrinfo" and arguments[0] not in (None, "", "localhost", "127.0.0.1", "0.0.0.0", "::1"):
        with open(os.environ["ASKED_FOR"], "a") as file:
            file.write(str(arguments[0]) + "\\n")
sys.addaudithook(heard)
"""
"""Put into every Python of the server: it notes the names of other machines that are looked up."""
CELLS = [
    ("code", "from gz_course.grader.tools.playground import Playground\nroom = Playground()"),
    ("code", 'sim = room.start("gz sim lidar_room.sdf -r -s")\nroom.show()'),
    ("markdown", "Open [`work.py`](../work.py)."),
    *[("markdown", "more\n\n" * 30)] * 3,
    ("code", "room.close()"),
]


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[tuple[str, Path]]:
    """The address of a JupyterLab as `make chapters` starts it, and the file with the names that it looks up."""
    pytest.importorskip("sidecar")
    (tmp_path / "watch").mkdir()
    (tmp_path / "watch" / "sitecustomize.py").write_text(WATCH)
    (tmp_path / "work.py").write_text("answer = 42\n")
    (tmp_path / "chapter").mkdir()
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    notebook = nbformat.v4.new_notebook(metadata={"kernelspec": kernel})
    notebook.cells = [getattr(nbformat.v4, f"new_{kind}_cell")(source) for kind, source in CELLS]
    nbformat.write(notebook, tmp_path / "chapter" / "chapter.ipynb")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    options = ["--no-browser", "--allow-root", f"--port={port}", "--ip=127.0.0.1", f"--ServerApp.root_dir={tmp_path}"]
    options += ["--IdentityProvider.token=", "--ServerApp.port_retries=0"]
    homes = {name: str(tmp_path) for name in ("HOME", "JUPYTER_DATA_DIR", "JUPYTER_CONFIG_DIR", "JUPYTER_RUNTIME_DIR")}
    heard = {"PYTHONPATH": str(tmp_path / "watch"), "ASKED_FOR": str(tmp_path / "asked")}
    log = tmp_path / "jupyter.log"
    with log.open("wb") as output:
        server = subprocess.Popen(
            [Path(sys.executable).with_name("jupyter"), "lab", *options],
            stderr=output,
            env=os.environ | homes | heard,
            start_new_session=True,
        )
    try:
        eventually(lambda: "is running at" in log.read_text() or server.poll() is not None, "Jupyter listens")
        assert server.poll() is None, log.read_text()
        yield f"http://127.0.0.1:{port}/lab/tree/chapter/chapter.ipynb", tmp_path / "asked"
    finally:
        os.killpg(server.pid, signal.SIGTERM)  # it ends its kernels
        server.wait(DEADLINE)


def run_cell(page: Any) -> None:
    page.keyboard.press("Shift+Enter")


def test_the_world_stands_beside_the_notebook(lab: tuple[str, Path]) -> None:
    address, asked = lab
    with watched_chromium() as (browser, outside):
        page = browser.new_page(viewport=SIZE)
        page.set_default_timeout(DEADLINE * 1000)
        page.goto(address)
        page.locator(".jp-Cell").first.click()
        page.locator(".jp-Notebook-ExecutionIndicator[data-status=idle]").first.wait_for()
        run_cell(page)
        run_cell(page)
        frame = page.locator(".jp-OutputArea iframe")
        frame.wait_for()
        said = page.locator(".jp-Notebook .jp-OutputArea-output", has_text="beside the notebook")
        said.wait_for()
        page.frame_locator(".jp-OutputArea iframe").locator("#canvas").wait_for()
        page.locator(".jp-Notebook .jp-Cell").last.scroll_into_view_if_needed()
        box, viewport = frame.bounding_box(), page.viewport_size
        assert box["x"] > viewport["width"] * 0.45 and box["height"] > viewport["height"] * 0.7, box
        assert page.locator(".jp-Notebook iframe").count() == 0
        page.get_by_role("link", name="work.py").click()
        page.locator(".jp-FileEditor", has_text="answer = 42").wait_for()
        assert page.get_by_text("Jupyter news").count() == 0
        assert outside.asked == set()
        assert not asked.exists(), asked.read_text()
        page.close()
