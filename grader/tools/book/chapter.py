"""A chapter of the book: its notebook is run from top to bottom in its own kernel and converted to a page."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from gz_course.grader.errors import CourseError

CELL_DEADLINE = 120  # [s]
# scripts of the template, which need the network; no page needs them
SCRIPT = re.compile(r"<script\b.*?</script>", re.DOTALL)
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
    where = {"metadata": {"path": str(chapter.notebook.parent)}}
    quiet = ["--log-level=ERROR"]
    try:
        NotebookClient(notebook, timeout=CELL_DEADLINE, resources=where, extra_arguments=quiet).execute()
    except (CellExecutionError, CellTimeoutError, DeadKernelError) as error:
        raise ChapterError(f"{chapter.notebook.name} does not run to its end:\n{COLOUR.sub('', str(error))}") from None
    return notebook


def page(chapter: Chapter, notebook: Any) -> str:
    """Return an executed notebook as one HTML page that loads nothing from elsewhere."""
    from nbconvert import HTMLExporter

    text, _ = HTMLExporter(embed_images=True).from_notebook_node(notebook, {"metadata": {"name": chapter.title}})
    return SCRIPT.sub("", text)
