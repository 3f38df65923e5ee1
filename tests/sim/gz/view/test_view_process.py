"""A view as a process: it says its address, listens on loopback only, and ends with its owner."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import urllib.error
import urllib.request
import uuid

import psutil
import pytest

from gz_course.sim.gz.view import View, ViewError, open_view, program
from gz_course.sim.gz.view.view_process import has_desktop

DEADLINE = 120


@pytest.fixture(autouse=True)
def partition(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GZ_IP", "127.0.0.1")
    monkeypatch.setenv("GZ_PARTITION", uuid.uuid4().hex)


def test_it_says_its_address_and_ends_with_its_owner(monkeypatch: pytest.MonkeyPatch) -> None:
    ended = threading.Event()
    view = View("some_world", on_end=lambda _: ended.set()).wait(DEADLINE)
    process = psutil.Process(view.pid)
    listening = [each.laddr.ip for each in process.net_connections("tcp") if each.status == psutil.CONN_LISTEN]
    assert listening and set(listening) == {"127.0.0.1"}, "also what Studio itself has opened"
    with urllib.request.urlopen(view.address, timeout=DEADLINE) as page:
        assert b"some_world" in page.read() and page.headers["X-Content-Type-Options"] == "nosniff"
    with urllib.request.urlopen(f"{view.address}web_client.wasm", timeout=DEADLINE) as answer:
        assert answer.headers["Content-Type"] == "application/wasm"
    for path in ("", "model", "web_client.js"):
        with pytest.raises(urllib.error.HTTPError, match="403"):
            urllib.request.urlopen("/".join([*view.address.split("/")[:3], path]), timeout=DEADLINE)

    opened: list[str] = []
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setattr("webbrowser.open", lambda address, new: not opened.append(address))
    assert has_desktop() and view.open_browser() and not view.open_browser()
    token = view.address.split("/")[3]
    assert token not in opened[0], "a command line can be read by everybody"
    with urllib.request.urlopen(opened[0], timeout=DEADLINE) as page:
        assert page.url == view.address

    view.close()
    assert not process.is_running() or process.status() == psutil.STATUS_ZOMBIE
    assert not ended.is_set(), "it was closed, it has not failed"
    with pytest.raises(ViewError):
        view.wait(0.0)


def test_without_a_desktop_no_browser_is_opened(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    assert not has_desktop() or sys.platform == "darwin"


def child(monkeypatch: pytest.MonkeyPatch, words: str) -> None:
    """Have the next view be a process that runs these words of a shell."""
    start = subprocess.Popen
    monkeypatch.setattr(subprocess, "Popen", lambda command, **options: start(["sh", "-c", words], **options))


def test_a_missing_studio_is_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    child(monkeypatch, "echo '! MuJoCo Studio is not here'; exit 3")
    with pytest.raises(ViewError, match=r"^MuJoCo Studio is not here$"):
        open_view("w", timeout=DEADLINE)


def test_a_view_that_breaks_down_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    child(monkeypatch, "exec 2>/dev/null; echo 'http://127.0.0.1:1/t/ http://127.0.0.1:1/open/o'; read line; exit 7")
    ended = threading.Event()
    with View("w", on_end=lambda _: ended.set()) as view:
        assert view.wait(DEADLINE).address == "http://127.0.0.1:1/t/"
        os.kill(view.pid, signal.SIGKILL)
        assert ended.wait(DEADLINE)
        assert view.error == "its process has ended with code -9"
        assert not view.running


def test_a_process_that_does_not_end_is_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gz_course.sim.gz.view.view_process._END_S", 0.05)
    child(monkeypatch, "trap '' TERM; echo 'http://127.0.0.1:1/t/ o'; while true; do read line || :; done")
    view = View("w").wait(DEADLINE)
    view.close()
    assert not view.running


def test_an_address_that_is_not_here_is_one_sentence(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    said = subprocess.run(
        [sys.executable, "-m", program.__name__.rpartition(".")[0], "--bind", "192.0.2.1"],
        input="",
        capture_output=True,
        text=True,
        timeout=DEADLINE,
        check=False,
    )
    assert said.returncode == program.NOT_OPEN and said.stderr == ""
    assert said.stdout == "! it cannot listen on 192.0.2.1 (Cannot assign requested address)\n"
