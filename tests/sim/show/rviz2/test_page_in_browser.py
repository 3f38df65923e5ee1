"""Rerun's page in a real browser: it shows a recording, and asks nobody outside of this machine."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from gz_course.grader.record.recorder import Recorder
from gz_course.grader.record.scene import shape
from gz_course.sim.show.rviz2.page_server import FOREIGN_LINK
from gz_course.sim.show.rviz2.viewer import FileServer, Viewer
from gz_course.tests.browser import DEADLINE, TRY, eventually, needs_chromium, watched_chromium


@pytest.mark.parametrize(
    "link",
    [
        b'<link rel="preconnect" href="https://fonts.example" />',
        b"<link\n  href='//fonts.example/css?a=b'\n  rel=stylesheet>",
        b"<LINK HREF=http://fonts.example>",
    ],
)
def test_links_to_other_machines_are_taken_out(link: bytes) -> None:
    own = b'<link rel="icon" href="favicon.ico" />'
    assert FOREIGN_LINK.sub(b"", own + link + own) == own + own


@pytest.mark.proof
@needs_chromium
def test_the_page_shows_a_recording_and_asks_no_other_machine(tmp_path: Path) -> None:
    path = tmp_path / "run.rrd"
    with Recorder(path, "robot") as recorder:
        recorder.static("/world/robot/base/visual", shape("box", [1, 1, 1], [1, 0, 0, 1]))
        recorder.pose("/world/robot", (0, 0, 0.5), (1, 0, 0, 0))
    with Viewer(web=True) as viewer, FileServer(path) as server, watched_chromium() as (browser, outside):
        page = browser.new_page()
        page.set_default_timeout(DEADLINE * 1000)
        said: list[Any] = []
        got: list[str] = []
        page.on("console", lambda message: said.append(message.text))
        page.on("requestfinished", lambda request: got.append(request.url))
        page.goto(viewer.address_of(server.url))
        eventually(lambda: page.wait_for_timeout(50) or any("App started" in each for each in said), "the viewer")
        eventually(lambda: page.wait_for_timeout(50) or server.url in got, "the recording")
        page.evaluate(TRY)
        assert outside.asked == set()
