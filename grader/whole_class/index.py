"""The gradebook of a class as one page: `index.html`, with search, sorting and pages, made for thousands of rows.

It works from a `file://` address and asks no network. The rows are data in the page; the script `index.js` puts the
few that are seen into the table, as text and never as markup: names and sentences are foreign.
"""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from gz_course.grader.exercise import Exercise
from gz_course.grader.printable import shown
from gz_course.grader.process.whole_file import write_whole
from gz_course.grader.report.format import formats
from gz_course.grader.whole_class.grading import REPORT

INDEX = "index.html"
FOLDER = Path(__file__).parent
STYLE = FOLDER.parent / "report" / "html" / "page.css"
LONGEST = 300  # [characters] of a sentence in the table


def as_page(exercise: Exercise, results: Sequence[dict[str, Any]], reports: Sequence[str]) -> str:
    """Return the page. `reports` are the formats that each student's folder has besides JSON."""
    script = (FOLDER / "index.js").read_text(encoding="ascii")
    policy = f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"
    data = {
        "checks": [{"id": check.id, "points": check.points} for check in exercise.checks],
        "most": exercise.max_score,
        "page": formats()["html"].file if "html" in reports else REPORT,
        "rows": [_row(exercise, result) for result in results],
    }
    environment = Environment(loader=FileSystemLoader(FOLDER), autoescape=True, undefined=StrictUndefined)
    return environment.get_template("index.html.jinja").render(
        title=f"{exercise.name}: {exercise.title}",
        count=len(results),
        style=Markup(STYLE.read_text(encoding="utf-8")),
        policy=Markup(policy),
        script=Markup(script),
        data=Markup(in_a_page(data)),
    )


def in_a_page(data: object) -> str:
    """Return data as JSON that ends no element of a page, and is plain ASCII."""
    text = json.dumps(data, ensure_ascii=True, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _row(exercise: Exercise, result: dict[str, Any]) -> list[Any]:
    points = [result["points"].get(check.id) for check in exercise.checks]
    told = shown(result["diagnosis"], LONGEST)
    return [result["student"], result["id"], result["score"], result["outcome"], told, result["folder"], points]


def write_index(folder: Path, exercise: Exercise, results: Sequence[dict[str, Any]], reports: Sequence[str]) -> None:
    """Write the page atomically: a reader sees the old one or the new one, never a part."""
    write_whole(folder / INDEX, as_page(exercise, results, reports).encode(), sole_writer=True)
