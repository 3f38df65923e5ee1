"""The pages that the grader writes, in a real browser: they ask no other machine, and axe-core finds nothing wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import nbformat
import pytest

from gz_course.grader.exercise import course_root, find_exercise
from gz_course.grader.grade import grade_again
from gz_course.grader.report.html.page import as_html
from gz_course.grader.report.html.replay import Replay
from gz_course.grader.tools.book.__main__ import front
from gz_course.grader.tools.book.chapter import chapters, page
from gz_course.grader.whole_class.index import as_page
from gz_course.tests.browser import TRY, Outside, needs_chromium, watched_chromium
from gz_course.tests.grader.report.handmade import write_run

pytestmark = needs_chromium
SIZE = {"width": 1280, "height": 900}


@pytest.fixture(scope="module")
def browser() -> Iterator[tuple[Any, Outside]]:
    with watched_chromium() as found:
        yield found


def report_page(folder: Path) -> str:
    lines = [(0.5, "[INFO] I drive"), (1.0, "ZeroDivisionError: division by zero")]
    return as_html(grade_again(write_run(folder / "03_teleop.rrd", lines=lines)))


def class_page(_: Path) -> str:
    exercise = find_exercise("03_teleop")
    points = {check.id: 0.0 for check in exercise.checks}
    row = {"student": "Zoë", "id": "7", "submission": "x", "score": 0, "points": points, "outcome": "graded"}
    more = {"diagnosis": "it stands", "folder": "zoe", "sha256": "", "truth_sha256": ""}
    return as_page(exercise, [row | more], ["html"])


def front_page(_: Path) -> str:
    return front(course_root())


def chapter_page(folder: Path) -> str:
    """A chapter as it is before it is run, with a picture and a replay as outputs."""
    chapter = chapters(course_root())[3]
    notebook = nbformat.read(chapter.notebook, as_version=4)
    replay = Replay(grade_again(write_run(folder / "03_teleop.rrd")))
    for cell in notebook.cells:
        if cell.cell_type == "code":
            cell.outputs = [nbformat.v4.new_output("display_data", replay._repr_mimebundle_())]
            break
    return page(chapter, notebook)


def faults_of(found: Any) -> list[str]:
    """Return what axe-core has found, a line an element."""
    return [
        f"{rule['id']}: {node['html'][:120]}: {(node['any'] + node['all'] + node['none'])[0]['message']}"
        for rule in found.response["violations"]
        for node in rule["nodes"]
    ]


@pytest.mark.parametrize("make", [report_page, class_page, front_page, chapter_page])
def test_a_page_asks_no_other_machine(
    browser: tuple[Any, Outside], make: Callable[[Path], str], tmp_path: Path
) -> None:
    (tmp_path / "page.html").write_text(make(tmp_path), encoding="utf-8")
    running, outside = browser
    seen = running.new_page(viewport=SIZE)
    seen.goto((tmp_path / "page.html").as_uri())
    assert outside.asked == set()
    seen.evaluate(TRY)
    seen.close()
    assert outside.asked == set(), "not even if it tries to"


@pytest.mark.proof
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("make", [report_page, class_page, front_page, chapter_page])
def test_axe_core_finds_nothing(
    browser: tuple[Any, Outside], make: Callable[[Path], str], scheme: str, tmp_path: Path
) -> None:
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    (tmp_path / "page.html").write_text(make(tmp_path), encoding="utf-8")
    seen = browser[0].new_page(viewport=SIZE, color_scheme=scheme)
    seen.goto((tmp_path / "page.html").as_uri())
    seen.evaluate("document.querySelectorAll('details').forEach((each) => { each.open = true; })")
    found = axe.run(seen)
    seen.close()
    assert not faults_of(found), "\n".join(faults_of(found))


LABELS = """() => [...document.querySelectorAll("svg.plot")].map((plot) =>
  [...plot.querySelectorAll("text")].map((label) => {
    const box = label.getBoundingClientRect(), edge = plot.getBoundingClientRect();
    return [box.left, box.top, box.right, box.bottom, edge.left, edge.top, edge.right, edge.bottom];
  }))"""


def test_labels_of_plots_are_readable_on_a_telephone(browser: tuple[Any, Outside], tmp_path: Path) -> None:
    (tmp_path / "page.html").write_text(report_page(tmp_path), encoding="utf-8")
    seen = browser[0].new_page(viewport={"width": 390, "height": 844})
    seen.goto((tmp_path / "page.html").as_uri())
    seen.evaluate("document.querySelectorAll('details').forEach((each) => { each.open = true; })")
    plots = seen.evaluate(LABELS)
    seen.close()
    assert plots and all(plots)
    for labels in plots:
        for number, (left, top, right, bottom, *edges) in enumerate(labels):
            assert bottom - top > 11.0, "the height of a line of 10 pixels"
            assert left > edges[0] - 3.0 and right < edges[2] + 3.0, "it is cut off"
            assert top > edges[1] - 3.0 and bottom < edges[3] + 3.0, "it is cut off"
            for others in labels[number + 1 :]:
                apart = (
                    others[0] > right - 1.0
                    or others[2] < left + 1.0
                    or others[1] > bottom - 3.0
                    or others[3] < top + 3.0
                )
                assert apart, "one label is drawn over another"
