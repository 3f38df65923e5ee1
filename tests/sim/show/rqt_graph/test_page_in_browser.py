"""The page of the node graph in a real browser: it shows the picture, and asks nobody outside of this machine."""

from __future__ import annotations

from gz_course.sim.show.rqt_graph.page import Page
from gz_course.tests.browser import DEADLINE, ELSEWHERE, TRY, needs_chromium, watched_chromium

SVG = f"""<svg xmlns="http://www.w3.org/2000/svg"><text id="node">/talker</text>
<image href="https://{ELSEWHERE}/picture.png"/></svg>"""


@needs_chromium
def test_a_page_asks_no_other_machine() -> None:
    with Page() as graph, watched_chromium() as (browser, outside):
        page = browser.new_page()
        page.set_default_timeout(DEADLINE * 1000)
        graph.show(SVG)
        page.goto(graph.address)
        page.locator("#node").wait_for()
        page.evaluate(TRY)
        page.close()
    assert outside.asked == set()
