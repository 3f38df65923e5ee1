"""`python -m grader.tools.book FOLDER` writes the book: a front page, a page per chapter, glossary and cheat sheet.

Chapters are run in a copy, so the course's own folders do not change. Exit code 1 if a chapter does not run.
"""

from __future__ import annotations

import re
import shutil
import sys
import tempfile
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

from gz_course.grader.errors import CourseError
from gz_course.grader.exercise import course_root
from gz_course.grader.tools.book.chapter import page, page_beside, run
from gz_course.grader.tools.book.cheat_sheet import CHEAT_SHEET
from gz_course.grader.tools.book.objectives import lessons

USAGE = "usage: python -m grader.tools.book FOLDER"
PAGES = {"Glossary": Path("chapters/glossary.ipynb"), "Cheat sheet": CHEAT_SHEET}  # beside the chapters
TRACES = ("runs", ".ipynb_checkpoints", "__pycache__")  # left behind by somebody at work, not part of the course


def main() -> int:
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        print(USAGE, file=sys.stderr)
        return 2
    try:
        write(course_root(), Path(sys.argv[1]))
    except CourseError as error:
        print(f"book: {error}", file=sys.stderr)
        return 1
    except OSError as error:
        print(f"book: cannot write {error.filename}: {error.strerror}", file=sys.stderr)
        return 2
    return 0


def write(root: Path, out: Path) -> None:
    """Run all chapters of the course at `root` and write the pages into the folder `out`."""
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="book-") as folder:
        copy = Path(folder)
        for half in ("chapters", "exercises"):
            shutil.copytree(root / half, copy / half, ignore=shutil.ignore_patterns(*TRACES))
        for lesson in lessons(copy):
            print(f"running {lesson.chapter.name}", flush=True)
            (out / f"{lesson.chapter.name}.html").write_text(page(lesson.chapter, run(lesson.chapter)))
    for path in PAGES.values():
        if (root / path).is_file():
            (out / path.with_suffix(".html").name).write_text(page_beside(root / path))
    (out / "index.html").write_text(front(root))
    print(f"{out / 'index.html'} is the front page")


def front(root: Path) -> str:
    """Return the front page: every chapter with its objectives, its exercise, the checks and what proves them."""
    loader = FileSystemLoader(Path(__file__).parent)
    environment = Environment(loader=loader, autoescape=True, undefined=StrictUndefined)
    environment.filters["code"] = lambda text: Markup(re.sub("`([^`]*)`", r"<code>\1</code>", str(escape(text))))
    beside = {name: path.with_suffix(".html").name for name, path in PAGES.items() if (root / path).is_file()}
    return environment.get_template("front.html").render(lessons=lessons(root), beside=beside)


if __name__ == "__main__":
    sys.exit(main())
