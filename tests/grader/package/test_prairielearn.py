"""The question for PrairieLearn: what is in its zip, and its grader, which always leaves a results.json."""

import json
import os
import subprocess
import sys
import zipfile
from html.parser import HTMLParser
from pathlib import Path

import pytest

from gz_course.grader.exercise import exercise_names, find_exercise
from gz_course.grader.package.prairielearn import IMAGE, package
from gz_course.tests.grader.prairielearn_results import read

FILE = "teleop_node.py"


@pytest.fixture(scope="module")
def question(root, tmp_path_factory):
    """The unpacked question."""
    folder = tmp_path_factory.mktemp("question")
    names = package(find_exercise("03_teleop", root), folder / "q.zip")
    with zipfile.ZipFile(folder / "q.zip") as packed:
        assert packed.getinfo("03_teleop/tests/run.sh").external_attr >> 16 & 0o111
        packed.extractall(folder)
    assert not [name for name in names if "/solutions/" in name and name.endswith(".py")]
    return folder / "03_teleop"


@pytest.fixture
def grader(question, tmp_path):
    """A scratch /grade; call it with files to submit."""
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/course").write_text(
        f'#!/bin/sh\nexec {sys.executable} -P -c "from gz_course.grader.course import main; main()" "$@"\n'
    )
    (tmp_path / "bin/course").chmod(0o755)
    (tmp_path / "student").mkdir()
    (tmp_path / "tests").mkdir()
    subprocess.run(["cp", "-r", f"{question}/tests/.", str(tmp_path / "tests")], check=True)

    def run(files, path=None):
        for name, data in files.items():
            (tmp_path / "student" / name).write_bytes(data)
        kept = {key: value for key, value in os.environ.items() if not key.startswith(("ROS_", "GZ_", "COURSE_"))}
        kept |= {"PRAIRIELEARN_ROOT": str(tmp_path), "PATH": path or f"{tmp_path}/bin:{os.environ['PATH']}"}
        done = subprocess.run(["bash", str(tmp_path / "tests/run.sh")], env=kept, capture_output=True, timeout=600)
        assert done.returncode == 0, done.stderr
        return read((tmp_path / "results/results.json").read_text())

    return run


def test_the_settings_of_the_question(question):
    info = json.loads((question / "info.json").read_text())
    assert info["gradingMethod"] == "External" and info["externalGradingOptions"]["image"] == IMAGE
    assert 0 < info["externalGradingOptions"]["timeout"] <= 600, "PrairieLearn's limit"
    entry = Path(info["externalGradingOptions"]["entrypoint"])
    assert (question / entry.relative_to("/grade")).is_file()
    text = (question / "tests/run.sh").read_text()
    assert "@" not in text.replace('"$@"', "") and "--trials" in text


class Elements(HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.found = [], []

    def handle_starttag(self, tag, attributes):
        self.open.append(tag)
        self.found.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_the_page_of_every_exercise_asks_for_its_files(root, tmp_path):
    for name in exercise_names(root):
        exercise = find_exercise(name, root)
        package(exercise, tmp_path / "q.zip")
        with zipfile.ZipFile(tmp_path / "q.zip") as packed:
            page = Elements()
            text = packed.read(f"{name}/question.html").decode()
            page.feed(text)
            given = {each.partition("clientFilesQuestion/")[2] for each in packed.namelist()} - {""}
        elements = dict(page.found)
        assert not page.open and "pl-external-grader-results" in elements
        assert {a["file-name"] for tag, a in page.found if tag == "pl-file-download"} == given
        wanted = elements["pl-file-upload"]["file-names"].split(", ")
        assert ("a zip of these files in their folders" in text) == (wanted == [f"{name}.zip"])
        assert wanted == list(exercise.parts) or (wanted == [f"{name}.zip"] and any("/" in n for n in exercise.parts))


@pytest.mark.proof
def test_what_cannot_be_read_costs_no_attempt(grader):
    results = grader({"a.py": b"", "b.py": b""})
    assert results["gradable"] is False and f"holds no {FILE}" in results["format_errors"][0]


def test_without_the_course_there_are_still_results(grader):
    results = grader({FILE: b""}, path="/usr/bin:/bin")
    assert results["gradable"] is False and "not your fault" in results["format_errors"][0]


@pytest.mark.proof
def test_a_right_submission(grader, root):
    results = grader({FILE: (root / "solutions/03_teleop" / FILE).read_bytes()})
    assert results["score"] == 1 and len(results["tests"]) == 6 and len(results["images"]) == 1


def test_the_command(course, tmp_path):
    out = tmp_path / "q.zip"
    outcome = course("package", "03", "--out", out, "--platform", "prairielearn", "--image", "uni/course:1")
    assert outcome.code == 0 and "Unpack it" in outcome.words
    with zipfile.ZipFile(out) as packed:
        assert json.loads(packed.read("03_teleop/info.json"))["externalGradingOptions"]["image"] == "uni/course:1"
    for more, words in (
        (["--platform", "prairelearn"], "did you mean 'prairielearn'"),
        (["--image", "x"], "--image is"),
    ):
        outcome = course("package", "03", "--out", tmp_path / "n.zip", *more)
        assert outcome.code == 2 and words in outcome.words
