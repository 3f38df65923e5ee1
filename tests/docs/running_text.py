"""The running text of the chapters: their paragraphs, without headings, objectives, quotes, tables and code."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import nbformat

FENCE = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
CODE = re.compile(r"`[^`]*`")
OUTSIDE = ("#", ">", "|", "- ", "* ", "    ", "!", "1. ")


def paragraphs(notebook: Path) -> Iterator[tuple[str, str]]:
    """Yield the paragraphs of a notebook, each with the id of its cell; those of its first cell are its frame."""
    cells = nbformat.read(notebook, as_version=4).cells[1:]
    for cell in cells:
        if cell.cell_type == "markdown":
            for each in FENCE.sub("", cell.source).split("\n\n"):
                if each.strip() and not each.startswith(OUTSIDE):
                    yield cell.id, each
