"""How long each chapter's notebook takes from first cell to last, against starting a kernel and a playground."""

import asyncio
import shutil
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import nbformat
from nbclient import NotebookClient

from gz_course.tests.bench.row import Row

ROOT = Path(__file__).parents[2]
LONGEST_RUN = 90  # [s] of one chapter
LONGEST_OF_ALL = 360  # [s] of all chapters together
EMPTY = (
    "from gz_course.grader.tools.playground import Playground\nimport matplotlib.pyplot as plt\nPlayground().close()"
)


def seconds(notebook: nbformat.NotebookNode, folder: Path) -> float:
    """Execute a notebook in a folder; return how long that took [s], its kernel's start included."""
    client = NotebookClient(notebook, timeout=LONGEST_RUN, resources={"metadata": {"path": str(folder)}})
    begin = time.monotonic()
    asyncio.run(client.async_execute())
    return time.monotonic() - begin


def rows() -> Iterator[Row]:
    total = 0.0
    with tempfile.TemporaryDirectory(prefix="bench-chapters-") as name:
        course = Path(name)
        for half in ("chapters", "exercises"):
            shutil.copytree(ROOT / half, course / half, ignore=shutil.ignore_patterns("runs", "__pycache__"))
        empty = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(EMPTY)])
        reference = seconds(empty, course)
        for path in sorted(course.glob("chapters/*/*.ipynb")):
            took = seconds(nbformat.read(path, as_version=4), path.parent)
            total += took
            yield Row(
                f"chapter {path.stem}",
                f"{took:.0f} s",
                f"an empty playground: {reference:.1f} s",
                f"{took / reference:.0f}",
                f"<= {LONGEST_RUN} s",
            )
    yield Row("all chapters", f"{total:.0f} s", f"an empty playground: {reference:.1f} s", "", f"<= {LONGEST_OF_ALL} s")
