"""The book of a small course: chapters run in a copy, pages load nothing, the front page maps checks to variants."""

import re
import shutil
import subprocess
import sys

import nbformat
import pytest

from gz_course.grader.errors import ManifestError
from gz_course.grader.tools.book import chapter as book_chapter
from gz_course.grader.tools.book.chapter import ChapterError, chapters, run
from gz_course.grader.tools.book.objectives import lessons
from gz_course.tests import warm_process
from gz_course.tests.import_arrows import ROOT

NAME = "03_teleop"
HEAD = """\
# 3. Driving <fast>

**Objectives.** After this chapter you can

- say `Twist`
  in two lines;
- stop.

It takes a minute.
"""


@pytest.fixture
def course(tmp_path, root):
    """A course with one exercise and a chapter whose notebook holds the given cell."""

    def write(cell, private=True):
        folder = tmp_path / "course"
        shutil.copytree(root / "exercises" / NAME, folder / "exercises" / NAME)
        if private:
            shutil.copytree(root / "solutions" / NAME, folder / "solutions" / NAME)
        notebook = nbformat.v4.new_notebook()
        notebook.cells = [nbformat.v4.new_markdown_cell(HEAD), nbformat.v4.new_code_cell(cell)]
        (folder / "chapters" / NAME).mkdir(parents=True)
        nbformat.write(notebook, folder / "chapters" / NAME / f"{NAME}.ipynb")
        return folder

    return write


def book(course, out):
    return warm_process.run(
        [sys.executable, "-m", "gz_course.grader.tools.book", str(out)],
        cwd=course,
        capture_output=True,
        text=True,
        timeout=600,
    )


def test_the_head_of_a_notebook_is_read(course):
    (chapter,) = chapters(course("1 + 1"))
    assert (chapter.name, chapter.title) == (NAME, "3. Driving <fast>")
    assert chapter.objectives == ("say `Twist` in two lines", "stop")


def test_each_objective_is_practised_asked_and_graded(root):
    """The table on the front page of the book has no hole; few objectives are graded by their cell alone."""
    holes, alone = [], []
    for lesson in lessons(root):
        for number, each in enumerate(lesson.objectives, start=1):
            name = f"{lesson.chapter.name} {number}"
            holes += [f"{name} is not {what}" for what in ("practised", "asked", "graded") if not getattr(each, what)]
            alone += [name] if all(check.startswith("cell ") for check in each.graded) else []
    assert holes == []
    assert len(alone) <= 3, alone


def test_a_hole_in_the_table_of_objectives_is_seen(course):
    folder = course("1 + 1")
    lesson = folder / "exercises" / NAME / "grading" / "lesson.toml"
    lesson.write_text(lesson.read_text().replace('3 = ["stops"]', '3 = ["cell:stop"]').partition("\n4 = ")[0])
    (found,) = lessons(folder)
    assert [each.practised for each in found.objectives] == [("turn_right",), ("circle",)]
    lesson.write_text(lesson.read_text().replace('1 = ["drives_forward"]', "").replace("[[review]]", "[[again]]"))
    (found,) = lessons(folder)
    assert found.objectives[0].graded == () and "review 1" not in found.objectives[1].asked


@pytest.mark.parametrize("wrong", ["drives_fast", "cell:circle", "04_lidar_listener:stops"])
def test_a_check_that_does_not_exist_grades_no_objective(course, wrong):
    folder = course("1 + 1")
    lesson = folder / "exercises" / NAME / "grading" / "lesson.toml"
    lesson.write_text(lesson.read_text().replace('1 = ["drives_forward"]', f'1 = ["{wrong}"]'))
    shutil.copytree(ROOT / "exercises" / "04_lidar_listener", folder / "exercises" / "04_lidar_listener")
    with pytest.raises(ManifestError, match=f"names '{wrong}', which is no check"):
        lessons(folder)


def test_every_check_is_mapped_to_the_variants_that_must_lose_it(course):
    (lesson,) = lessons(course("1 + 1"))
    assert lesson.exercise.name == NAME
    proven = {each.check.id: each.rejected for each in lesson.proven}
    assert set(proven) == {check.id for check in lesson.exercise.checks}
    assert "never_stops" in proven["stops"] and "never_stops" not in proven["turns_left"]
    assert all(proven.values())


def test_the_book_is_written_and_the_course_left_as_it_is(course, tmp_path):
    folder = course("from pathlib import Path\nPath('left.txt').write_text('x')\nprint(6 * 7)")
    before = sorted(folder.rglob("*"))
    done = book(folder, tmp_path / "out")
    assert (done.returncode, done.stderr) == (0, "")
    assert sorted(folder.rglob("*")) == before
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [f"{NAME}.html", "index.html"]
    page, front = ((tmp_path / "out" / name).read_text() for name in (f"{NAME}.html", "index.html"))
    assert re.search(r"<pre>42\n?</pre>", page)
    for text in (page, front):
        assert "<script" not in text
        assert re.findall(r'(?:src|href)="(?!#|data:)([^"]*)"', text) in ([], [f"{NAME}.html"])
    assert "Driving &lt;fast&gt;" in front and "say <code>Twist</code> in two lines" in front
    assert "<code>never_stops</code>" in front


@pytest.mark.proof
def test_a_students_copy_has_a_book_without_variants(course, tmp_path):
    done = book(course("1", private=False), tmp_path / "out")
    assert (done.returncode, done.stderr) == (0, "")
    front = (tmp_path / "out" / "index.html").read_text()
    assert "rejected" not in front and "Stops and stays stopped" in front


def test_a_chapter_that_does_not_run_is_named_with_its_error(course, tmp_path):
    done = book(course("raise ValueError('no robot')"), tmp_path / "out")
    assert done.returncode == 1
    assert f"book: {NAME}.ipynb does not run to its end" in done.stderr and "no robot" in done.stderr
    assert "\x1b" not in done.stderr and "grader/book" not in done.stderr
    assert not (tmp_path / "out" / "index.html").exists()


@pytest.mark.parametrize("words", [[], ["a", "b"], ["--help"]])
def test_without_a_folder_it_says_how_it_is_used(words):
    done = subprocess.run(
        [sys.executable, "-m", "gz_course.grader.tools.book", *words], capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 2 and done.stderr.startswith("usage: ")


@pytest.mark.proof
def test_a_picture_beside_a_notebook_is_in_its_page(course):
    (chapter,) = chapters(course("1 + 1"))
    (chapter.notebook.parent / "figure.svg").write_text("<svg xmlns='http://www.w3.org/2000/svg'/>")
    notebook = nbformat.read(chapter.notebook, as_version=4)
    notebook.cells.append(nbformat.v4.new_markdown_cell("![What is drawn.](figure.svg)"))
    text = book_chapter.page(chapter, notebook)
    assert 'src="data:image/svg+xml;base64,' in text and "figure.svg" not in text


@pytest.mark.proof
def test_a_cell_that_hangs_is_named_and_ended(course, monkeypatch):
    monkeypatch.setattr(book_chapter, "CELL_DEADLINE", 1.0)
    (chapter,) = chapters(course("import threading; threading.Event().wait()"))
    with pytest.raises(ChapterError, match=r"hangs: cell \w+ is not done after 1 s, of which it computed 0 s"):
        run(chapter)
