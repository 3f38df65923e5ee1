"""What is put into Studio's page: its script, its name, and what is read aloud of the picture.

Studio's page is one canvas. Around it come a heading, a text of what the world does, and the list of keys, which are
there for screen readers only. The page asks the view for the text once a second, and only while it is visible; the
part that is read aloud by itself changes when the world does something else, not while it goes on doing it.

Source: mujoco/studio/web/index.html of mujoco-studio 4.0.0
Source: https://www.w3.org/TR/wai-aria-1.2/#status
"""

from __future__ import annotations

import html
import re

from gz_course.sim.gz.view.keys import KEYS

TOLD, STILL = "told", "still"
"""The path that answers with the text, and the query of a reader who wants motion reduced."""
_SCRIPT = """<script>
(() => {
  const base = location.pathname.replace(/[^/]*$/, "");
  const plainFetch = window.fetch.bind(window);
  window.fetch = (what, options) =>
    plainFetch(typeof what === "string" && what.startsWith("/") ? base + what.slice(1) : what, options);
  const PlainSocket = window.WebSocket;
  window.WebSocket = class extends PlainSocket {
    constructor(url, protocols) {
      const there = new URL(url, location.href);
      there.pathname = base + there.pathname.slice(1);
      super(there.href, protocols || []);
    }
  };
  for (const name of ["sessionStorage", "localStorage"]) {  // a page in a frame of another site has none
    try { window[name].length; } catch {
      const kept = new Map();
      Object.defineProperty(window, name, {value: {
        getItem: (key) => kept.has(key) ? kept.get(key) : null,
        setItem: (key, value) => { kept.set(key, String(value)); },
        removeItem: (key) => { kept.delete(key); },
      }});
    }
  }
  addEventListener("DOMContentLoaded", () => {  // Studio's program would write its own name over it
    const title = document.title;
    Object.defineProperty(document, "title", {get: () => title, set: () => {}});
  });
  addEventListener("keydown", (event) => {  // Studio takes every key; this one leads out of the page
    if (event.key === "Tab") event.stopImmediatePropagation();
  }, true);
  const still = matchMedia("(prefers-reduced-motion: reduce)");
  const put = (id, text) => {
    const where = document.getElementById(id);
    if (where && where.textContent !== text) where.textContent = text;
  };
  const read = async () => {
    if (document.visibilityState !== "visible") return;
    try {
      const told = await (await plainFetch(base + "@TOLD@" + (still.matches ? "?@STILL@" : ""))).json();
      put("spoken", told.spoken || "");
      put("whole", told.whole || "");
    } catch {
      put("spoken", "The view has ended.");
    }
  };
  addEventListener("load", async () => {
    for (;;) { await read(); await new Promise((done) => setTimeout(done, 1000)); }
  });
  if (!window.crossOriginIsolated) addEventListener("DOMContentLoaded", () => {
    const said = document.createElement("p");
    said.style.cssText = "position:absolute;top:0;margin:1em;color:#fff;font:16px sans-serif;z-index:9";
    said.innerHTML = 'This browser shows the world only in a tab of its own: ' +
      '<a style="color:#8cf" target="_blank" rel="noopener">open it</a>.';
    said.querySelector("a").href = location.href;
    document.body.appendChild(said);
  });
})();
</script>""".replace("@TOLD@", TOLD).replace("@STILL@", STILL)
_STYLE = """<style>
.heard { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
#canvas:focus-visible { outline: 3px solid #1c5fd4; outline-offset: -3px; }
</style>"""
_CANVAS = re.compile(r'<canvas id="canvas"([^>]*)></canvas>')


def furnished(page: str, title: str) -> str:
    """Return Studio's page with all that is added to it. Raises ValueError if it is another page."""
    if "<head>" not in page:
        raise ValueError("the page of MuJoCo Studio has no <head>")
    page = page.replace("<head>", f"<head>{_SCRIPT}{_STYLE}", 1)
    page = page.replace("<title>MuJoCo Web Viewer</title>", f"<title>{html.escape(title)}</title>", 1)
    page = page.replace("<html>", '<html lang="en">', 1)
    return _CANVAS.sub(lambda found: _around(found[1], title), page, count=1)


def _around(attributes: str, title: str) -> str:
    """Return the canvas with a heading, the text and the keys."""
    keys = "".join(f"<li>{html.escape(f'{key.shown}: {key.does}')}</li>" for key in KEYS)
    return (
        f'<main><h1 class="heard">{html.escape(title)}</h1>'
        f'<canvas id="canvas" role="application" tabindex="0" aria-label="Picture of the world, driven by keys"'
        f' aria-describedby="spoken"{attributes}></canvas>'
        f'<div class="heard"><p id="spoken" role="status"></p><p id="whole"></p>'
        f"<h2>Keys</h2><ul>{keys}</ul></div></main>"
    )
