"""No prose uses what the table of `docs/style.md` says not to write."""

import json
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
STYLE = ROOT / "docs/style.md"
PAGES = [
    *ROOT.glob("*.md"),
    *(page for page in (ROOT / "docs").glob("*.md") if page != STYLE),
    *(page for room in ("chapters", "sim", "grader", "exercises") for page in (ROOT / room).rglob("*.md")),
]


def avoided():
    """The expressions of the column `not`, without explanations."""
    table = STYLE.read_text().split("| write | not |\n")[1].split("\n\n")[0]
    columns = [line.strip("| ").split(" | ") for line in table.splitlines()[1:]]
    return [wrong.split(",")[0] for _, wrong in columns if ", as in" not in wrong]


def prose():
    """Yield the path and the text of each page, notebook and manifest; spaces for line breaks."""
    for page in PAGES:
        yield page, page.read_text()
    for notebook in (ROOT / "chapters").rglob("*.ipynb"):
        cells = json.loads(notebook.read_text())["cells"]
        yield notebook, "\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "markdown")
    for manifest in (ROOT / "exercises").glob("*/grading/exercise.toml"):
        yield manifest, manifest.read_text()


def test_no_page_uses_an_avoided_expression():
    wrong = avoided()
    assert {"mend", "at last", "commonest"} <= set(wrong)
    pattern = re.compile(rf"\b(?:{'|'.join(map(re.escape, wrong))})s?\b", re.IGNORECASE)
    found = [
        f"{path.relative_to(ROOT)}: {match.group()}"
        for path, text in prose()
        for match in pattern.finditer(" ".join(text.split()))
    ]
    assert found == []
