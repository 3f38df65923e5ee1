"""The glossary of the course, and where the chapters first use its terms."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import nbformat

from gz_course.tests.docs.running_text import CODE, paragraphs

LINK = re.compile(r"\[(?P<words>[^\]]+)\]\(\.\./glossary\.ipynb#(?P<anchor>[^)]+)\)")
ANY_LINK = re.compile(r"\]\([^)]*\)")
# Other spellings, and uses of the same word in another sense: the id of a cell, or a pattern.
ALSO = {
    "QoS": r"QoS|quality of service",
    "service": r"(?<!quality of )service",
    "graph": r"(?<=ROS )graph|(?<=ROS \[)graph",
}
NOT_MEANT = {
    "action": r"0\d-\d+",  # of a launch file
    "frame": r"0[0-3]-\d+",  # of a film
    "goal": r"0\d-\d+",
    "feedback": r"0\d-\d+",
}


@dataclass(frozen=True)
class Use:
    """The first use of a term: the notebook, the cell, its paragraph and the words used."""

    notebook: Path
    cell: str
    paragraph: str
    words: str


def entries(glossary: Path) -> dict[str, str]:
    """Return the terms of the glossary with what it says about them."""
    found = {}
    for cell in nbformat.read(glossary, as_version=4).cells[1:]:
        heading, _, text = cell.source.partition("\n\n")
        found[heading.removeprefix("## ")] = text
    return found


def anchor(term: str) -> str:
    """Return where a link to a term leads within the page: notebooks write a blank as a hyphen."""
    return term.replace(" ", "-")


def pattern(term: str) -> re.Pattern[str]:
    case = 0 if term[:2].isupper() or term[1:] != term[1:].lower() or term == "Twist" else re.IGNORECASE
    return re.compile(rf"(?<![\w/-])(?:{ALSO.get(term, re.escape(term))})s?(?![\w/-])", case)


def first_use(term: str, notebooks: list[Path]) -> Use | None:
    """Return the first use of a term in the running text of the chapters."""
    for notebook in notebooks:
        for cell, paragraph in paragraphs(notebook):
            seen = CODE.sub(lambda code: " " * len(code.group()), ANY_LINK.sub(_blank, paragraph))
            if (found := pattern(term).search(seen)) and not _elsewhere(term, cell, paragraph):
                return Use(notebook, cell, paragraph, found.group())
    return None


def _blank(link: re.Match[str]) -> str:
    return "]" + " " * (len(link.group()) - 1)


def _elsewhere(term: str, cell: str, paragraph: str) -> bool:
    return term in NOT_MEANT and bool(re.match(NOT_MEANT[term], f"{cell}: {paragraph}".replace("\n", " ")))
