"""A real browser for tests: Chromium, and `Outside`, which hears whatever it asks of another machine."""

from __future__ import annotations

import contextlib
import shutil
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import urlsplit

import pytest

from gz_course.tests.eventually import within

CHROMIUM = shutil.which("chromium")
FLAGS = ["--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
DEADLINE = 500.0
"""Time [s] to wait for anything; without a GPU a busy machine draws a picture in many seconds."""
eventually = within(DEADLINE, pause=0.05)
ITS_OWN = {"accounts.google.com", "content-autofill.googleapis.com", "update.googleapis.com"}
"""What Chromium itself asks, whatever page it shows."""
ELSEWHERE = "elsewhere.example"
TRY = f"""async () => {{
  const tried = [];
  const one = (promise) => tried.push(Promise.resolve(promise).catch(() => 0));
  one(fetch("https://{ELSEWHERE}/fetch", {{mode: "no-cors"}}));
  one(fetch("https://{ELSEWHERE}/post", {{mode: "no-cors", method: "POST", body: "x"}}));
  for (const [tag, name] of [["img", "src"], ["script", "src"], ["link", "href"]]) {{
    one(new Promise((done) => {{
      const made = document.createElement(tag);
      made.onload = made.onerror = done;
      if (tag === "link") made.rel = "stylesheet";
      made[name] = "https://{ELSEWHERE}/" + tag;
      document.body.append(made);
      document.addEventListener("securitypolicyviolation", (e) => e.blockedURI.endsWith(tag) && done());
    }}));
  }}
  await Promise.all(tried);
}}"""
"""JavaScript by which a page tries to ask another machine in the usual ways, and waits for what becomes of it.

Not a frame: Chromium connects to its server before it asks the policy, and then loads nothing.
"""

needs_chromium = pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here: apt-get install chromium")


class Outside:
    """The proxy of a browser for all other machines: it answers nothing, and `asked` are the hosts it was asked for."""

    def __init__(self) -> None:
        self.asked: set[str] = set()
        asked = self.asked

        class Handler(BaseHTTPRequestHandler):
            def do_CONNECT(self) -> None:
                host = self.path.rpartition(":")[0] if self.command == "CONNECT" else str(urlsplit(self.path).hostname)
                if host not in ITS_OWN:
                    asked.add(host)
                self.send_error(502)

            do_GET = do_POST = do_HEAD = do_OPTIONS = do_CONNECT

            def log_message(self, *_: object) -> None:
                pass

        self._server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        threading.Thread(target=self._server.serve_forever, daemon=True).start()

    @property
    def proxy(self) -> dict[str, str]:
        return {"server": f"http://127.0.0.1:{self._server.server_address[1]}", "bypass": "127.0.0.1,localhost"}

    def close(self) -> None:
        self._server.shutdown()
        self._server.server_close()


@contextlib.contextmanager
def chromium(outside: Outside | None = None) -> Iterator[Any]:
    """Yield a running Chromium; with `outside`, nothing else leads to other machines."""
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as driver:
        proxy = None if outside is None else outside.proxy
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS, proxy=proxy)
        yield browser
        browser.close()


@contextlib.contextmanager
def watched_chromium() -> Iterator[tuple[Any, Outside]]:
    """Yield a Chromium and what it asks of other machines."""
    outside = Outside()
    try:
        with chromium(outside) as browser:
            yield browser, outside
    finally:
        outside.close()
