"""The gradebook of a class as one page: `index.html`, with search, sorting and pages, made for thousands of rows.

It works from a `file://` address and asks no network. The rows are data in the page; the script `index.js` puts the
few that are seen into the table, as text and never as markup: names and sentences are foreign.
"""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from gz_course.grader.exercise import Exercise
from gz_course.grader.printable import shown
from gz_course.grader.process.whole_file import write_whole
from gz_course.grader.report.format import formats
from gz_course.grader.whole_class.explained import Explained, groups, read_explanations
from gz_course.grader.whole_class.grading import REPORT
from gz_course.grader.whole_class.kept import RECORDING
from gz_course.grader.whole_class.leaderboard import boards

INDEX = "index.html"
FOLDER = Path(__file__).parent
STYLE = FOLDER.parent / "report" / "html" / "page.css"
LONGEST = 300  # [characters] of a sentence in the table
MOST_FAULTS = 12  # that several students share, in the summary
VARIES = re.compile(r"-?[0-9]+(?:\.[0-9]+)?|'[^']*'|`[^`]*`|\"[^\"]*\"")


def as_page(
    exercise: Exercise,
    results: Sequence[dict[str, Any]],
    reports: Sequence[str],
    explained: Mapping[str, Explained] = MappingProxyType({}),
    recordings: Mapping[str, Sequence[str]] = MappingProxyType({}),
) -> str:
    """Return the page. `reports` are the formats that each student's folder has besides JSON.

    `explained` is what a search found for students, `recordings` the names of files that they have; both by name.
    """
    found = groups(explained.values())
    names = [name for name, _ in found]
    faults = _faults(results)
    script = (FOLDER / "index.js").read_text(encoding="ascii")
    policy = f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"
    data = {
        "exercise": exercise.name,
        "checks": [{"id": check.id, "points": check.points} for check in exercise.checks],
        "most": exercise.max_score,
        "page": formats()["html"].file if "html" in reports else REPORT,
        "groups": found,
        "faults": [[shown(example, LONGEST), count] for example, count in faults.values()],
        "rows": [
            [
                *_row(exercise, result, explained.get(result["student"]), names),
                recordings.get(result["student"], ()),
                (result.get("submitted") or "")[:16].replace("T", " "),
                result.get("attempts", 1),
                [*faults].index(_alike(result)) if _alike(result) in faults else None,
                result.get("changes", ()),
            ]
            for result in results
        ],
    }
    environment = Environment(loader=FileSystemLoader(FOLDER), autoescape=True, undefined=StrictUndefined)
    return environment.get_template("index.html.jinja").render(
        title=f"{exercise.name}: {exercise.title}",
        count=len(results),
        boards=boards(exercise, results),
        style=Markup(STYLE.read_text(encoding="utf-8")),
        policy=Markup(policy),
        script=Markup(script),
        data=Markup(in_a_page(data)),
    )


def _alike(result: dict[str, Any]) -> str:
    """Return what the first sentences on one fault have in common: numbers and quoted names make no difference."""
    return VARIES.sub("*", result["diagnosis"].partition(". ")[0])


def _faults(results: Sequence[dict[str, Any]]) -> dict[str, tuple[str, int]]:
    """Return the faults that several students share, the most common first: an example, and how many have it."""
    alike = [(_alike(result), result["diagnosis"]) for result in results if result["diagnosis"]]
    counts = Counter(key for key, _ in alike)
    examples = dict(reversed(alike))
    shared = sorted((key for key in counts if counts[key] > 1), key=lambda key: (-counts[key], key))[:MOST_FAULTS]
    return {key: (examples[key], counts[key]) for key in shared}


def in_a_page(data: object) -> str:
    """Return data as JSON that ends no element of a page, and is plain ASCII."""
    text = json.dumps(data, ensure_ascii=True, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _row(exercise: Exercise, result: dict[str, Any], explained: Explained | None, known: Sequence[str]) -> list[Any]:
    points = [result["points"].get(check.id) for check in exercise.checks]
    tried = explained.sentences[0] if explained is not None else ""
    changed = f"Changed: {'; '.join(result['changes'])}." if result.get("changes") else ""
    told = shown(" ".join(filter(None, (changed, *result.get("notes", ()), tried, result["diagnosis"]))), LONGEST)
    group = known.index(explained.group) if explained is not None else None
    return [result["student"], result["id"], result["score"], result["outcome"], told, result["folder"], points, group]


def write_index(folder: Path, exercise: Exercise, results: Sequence[dict[str, Any]], reports: Sequence[str]) -> None:
    """Write the page atomically: a reader sees the old one or the new one, never a part."""
    recordings = {
        each["student"]: sorted(path.name for path in (folder / each["folder"]).glob(f"*{RECORDING}"))
        for each in results
    }
    page = as_page(exercise, results, reports, read_explanations(folder, results), recordings)
    write_whole(folder / INDEX, page.encode(), sole_writer=True)
