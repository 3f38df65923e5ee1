"""The page of `gz sim` without a world: what it offers, whom it answers, and where it leads."""

from __future__ import annotations

import re
import threading
import urllib.error
import urllib.parse
import urllib.request
from collections.abc import Iterator

import pytest

from gz_course.sim.gz.sim.sdf.resources import known_worlds
from gz_course.sim.gz.view.start_page import StartPage

WORLDS = {"empty.sdf": "Nothing", "<b>.sdf": "a & b"}


@pytest.fixture
def page() -> Iterator[StartPage]:
    with StartPage(WORLDS) as made:
        yield made


def ask(address: str, world: str | None = None, **headers: str) -> tuple[int, str]:
    data = None if world is None else urllib.parse.urlencode({"world": world}).encode()
    request = urllib.request.Request(address, data, headers)
    try:
        with urllib.request.urlopen(request, timeout=60) as answer:
            return answer.status, answer.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()


def test_a_world_is_chosen_and_the_page_leads_to_its_view(page: StartPage) -> None:
    status, text = ask(page.address)
    assert status == 200 and re.findall('value="(.*?)"', text) == ["empty.sdf", "&lt;b&gt;.sdf"] and "a &amp; b" in text
    assert ask(f"{page.address}view") == (204, "")
    assert "world empty.sdf is being loaded" in ask(f"{page.address}start", "empty.sdf")[1]
    assert page.wait(threading.Event()) == "empty.sdf"
    ask(f"{page.address}start", "<b>.sdf")
    assert page.wait(threading.Event()) == "empty.sdf", "the first choice counts"
    page.lead_to("http://127.0.0.1:1/x/")
    assert ask(f"{page.address}view") == (200, "http://127.0.0.1:1/x/")


def test_nobody_else_chooses(page: StartPage) -> None:
    origin = page.address.rsplit("/", 2)[0]
    assert ask(f"{origin}/")[0] == ask(f"{origin}/wrong/")[0] == ask(f"{origin}/wrong/start", "empty.sdf")[0] == 403
    assert ask(f"{page.address}start", "empty.sdf", Origin="http://other.example")[0] == 403
    assert ask(f"{page.address}start", "other.sdf")[0] == ask(f"{page.address}start", "x" * 5000)[0] == 400
    stop = threading.Event()
    stop.set()
    assert page.wait(stop) == ""


def test_the_browser_opens_it_by_an_address_that_works_once(page: StartPage, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setenv("DISPLAY", ":1")
    monkeypatch.setattr("webbrowser.open", lambda address, new: opened.append(address) or True)
    assert page.open_browser()
    token = page.address.split("/")[-2]
    assert token not in opened[0], "everybody may read the command line of a browser"
    assert ask(opened[0])[0] == 200 and ask(opened[0])[0] == 403


def test_worlds_come_with_a_line_about_them() -> None:
    found = known_worlds()
    assert found["lidar_room.sdf"] and found["diff_drive.sdf"].startswith("Two vehicles with a differential drive")
