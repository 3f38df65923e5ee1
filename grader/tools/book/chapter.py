"""A chapter of the book: its notebook is run from top to bottom in its own kernel and converted to a page."""

from __future__ import annotations

import os
import re
import signal
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gz_course.grader.errors import CourseError
from gz_course.grader.run.fair_clock import FairClock, Patience
from gz_course.grader.run.sandbox.resource_monitor import descendants

CELL_DEADLINE = 120.0  # [s] in which a cell waits or computes; waiting for a processor does not count
LOOK_AGAIN = 0.5  # [s] between two looks at the time while a cell runs
# scripts of the template, which need the network; no page needs them
SCRIPT = re.compile(r"<script\b.*?</script>", re.DOTALL)
# Scripts are those of replays, whose frames have a stricter policy of their own.
POLICY = (
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
    'script-src \'unsafe-inline\'; img-src data:; font-src data:"><meta name="referrer" content="no-referrer">'
)
# Colours of the template with which some readers cannot read: less than 4.5 to 1 on the background.
STYLE = """<style>
:root {
  --jp-cell-prompt-not-active-font-color: #545d68; --jp-cell-inprompt-font-color: #545d68;
  --jp-mirror-editor-comment-color: #2c6464; --jp-mirror-editor-number-color: #006b00;
  --jp-mirror-editor-operator-color: #8a12d1; --jp-cell-prompt-not-active-opacity: 1; --jp-cell-prompt-opacity: 1;
}
.highlight .ow { color: #8a12d1; }
.jp-RenderedHTMLCommon a:any-link { text-decoration: underline; }
</style>"""
GLOSSARY = re.compile(r'href="\.\./glossary\.ipynb')  # where links of the chapters lead, seen from their folders
COLOUR = re.compile(r"\x1b\[[0-9;]*m")
OBJECTIVES = re.compile(r"^\*\*Objectives\.\*\*.*?\n\n(?P<list>(?:- .*\n(?:  .*\n)*)+)", re.MULTILINE)


class ChapterError(CourseError):
    """A notebook does not run; the chapter's author must mend it."""


@dataclass(frozen=True)
class Chapter:
    """The description of a chapter from the head of its notebook."""

    name: str
    notebook: Path
    title: str
    objectives: tuple[str, ...]


def chapters(root: Path) -> list[Chapter]:
    """Return the chapters below a course folder, in order."""
    return [_read(path) for path in sorted((root / "chapters").glob("*/*.ipynb"))]


def _read(path: Path) -> Chapter:
    import nbformat

    head = nbformat.read(path, as_version=4).cells[0].source + "\n"
    title = head.partition("\n")[0].lstrip("# ")
    found = OBJECTIVES.search(head)
    points = re.split(r"^- ", found["list"], flags=re.MULTILINE)[1:] if found else []
    return Chapter(path.stem, path, title, tuple(" ".join(point.split()).rstrip(".;") for point in points))


def run(chapter: Chapter) -> Any:
    """Run a chapter's notebook in its folder and return it with its outputs. Raises ChapterError with the cell."""
    import nbformat
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError

    notebook = nbformat.read(chapter.notebook, as_version=4)
    watch = _CellWatch()
    where = {"metadata": {"path": str(chapter.notebook.parent)}}
    quiet = ["--log-level=ERROR"]
    client = NotebookClient(notebook, timeout=None, resources=where, extra_arguments=quiet)
    client.on_cell_execute, client.on_cell_executed = watch.begin, watch.end
    watch.client = client
    try:
        client.execute()
    except (CellExecutionError, CellTimeoutError, DeadKernelError) as error:
        if watch.overdue:
            raise ChapterError(f"{chapter.notebook.name} hangs: {watch.overdue}") from None
        raise ChapterError(f"{chapter.notebook.name} does not run to its end:\n{COLOUR.sub('', str(error))}") from None
    return notebook


class _CellWatch:
    """Interrupts a cell that takes longer than `CELL_DEADLINE`; `overdue` says which, and whether it computed."""

    def __init__(self) -> None:
        self.client: Any = None
        self.overdue = ""
        self._done = threading.Event()

    def begin(self, cell: Any, cell_index: int, **_: Any) -> None:
        self._done = threading.Event()
        threading.Thread(target=self._watch, args=(cell, self._done), daemon=True).start()

    def end(self, **_: Any) -> None:
        self._done.set()

    def _watch(self, cell: Any, done: threading.Event) -> None:
        clock = FairClock(lambda: [os.getpid(), *descendants(os.getpid())])
        patience = Patience(clock, CELL_DEADLINE)
        while not done.wait(LOOK_AGAIN):
            if patience.over():
                busy = clock.now() - clock.idle()
                self.overdue = (
                    f"cell {cell.id} is not done after {CELL_DEADLINE:g} s, of which it computed {busy:.0f} s"
                )
                os.kill(self.client.km.provisioner.pid, signal.SIGINT)
                return


def page(chapter: Chapter, notebook: Any) -> str:
    """Return an executed notebook as one HTML page that loads nothing from elsewhere."""
    from nbconvert import HTMLExporter

    about = {"metadata": {"name": chapter.title, "path": str(chapter.notebook.parent)}}  # where its pictures are
    text, _ = HTMLExporter(embed_images=True).from_notebook_node(notebook, about)
    text = GLOSSARY.sub('href="glossary.html', SCRIPT.sub("", text))
    return text.replace("<head>", f"<head>{POLICY}", 1).replace("</head>", f"{STYLE}</head>", 1)


def page_beside(path: Path) -> str:
    """Return a page that belongs to no chapter: a page as it is, or a notebook, which is not run, as a page."""
    import nbformat

    if path.suffix == ".html":
        return path.read_text()
    notebook = nbformat.read(path, as_version=4)
    return page(Chapter(path.stem, path, notebook.cells[0].source.partition("\n")[0].lstrip("# "), ()), notebook)
