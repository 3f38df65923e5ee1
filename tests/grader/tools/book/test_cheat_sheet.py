"""The cheat sheet: what the code's tables say, in a page that needs nothing else, on two printed pages."""

import re
import shutil
import subprocess

import pytest

from gz_course.grader.course_folder.layout import handed_out
from gz_course.grader.tools.book.cheat_sheet import CHEAT_SHEET, EXAMPLES, bridged, cheat_sheet, type_pairs
from gz_course.sim.bridge.ros_gz_bridge.arguments import MARKS
from gz_course.sim.bridge.ros_gz_bridge.entry_reader import KEYS
from gz_course.sim.bridge.ros_gz_bridge.qos_profile import QOS_PROFILES
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import pairs
from gz_course.sim.gz.command import find_commands
from gz_course.sim.ros.ros2.command_line import COMMANDS, found
from gz_course.tests.import_arrows import ROOT

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
PAGE = re.compile(rb"/Type\s*/Page\b")
STUDENTS = {"diagnose", "doctor", "grade", "graph", "hint", "init", "list", "reset", "show", "update", "watch"}


@pytest.fixture(scope="module")
def text():
    return (ROOT / CHEAT_SHEET).read_text()


def test_it_is_what_the_tables_of_the_code_give(text):
    assert text == cheat_sheet(ROOT), "run python -m gz_course.grader.tools.book.cheat_sheet"


def test_each_command_is_there(text):
    shown = text.replace("&nbsp;", " ")
    assert [name for name in find_commands() if f"gz {name}<" not in shown] == []
    assert [
        name for name in found(COMMANDS) if f"ros2 {name}<" not in shown and f"<code>{name}</code>" not in shown
    ] == []
    assert set(re.findall(r"<code>course ([a-z-]+)<", shown)) >= STUDENTS


def test_marks_keys_profiles_and_types_are_there(text):
    assert all(f"<code>{mark}</code></td><td><code>{way.value}</code>" in text for mark, way in MARKS.items())
    assert all(f"<code>{key}</code>" in text for key in (*KEYS, *QOS_PROFILES))
    named = {name.partition(" = ")[0] for names in type_pairs().values() for name in names}
    assert {pair.ros_type.rpartition("/")[2] for pair in pairs()} == named


def test_examples_are_commands_that_there_are():
    for name, example in EXAMPLES.items():
        first, second, verb, *_ = example.split()
        assert (first, second) == ("ros2", name)
        path = found(COMMANDS)[name]
        assert not path.is_dir() or verb in found(path)


def test_it_gives_no_answer_of_an_exercise_away():
    """The bridges of the exercises on bridges and topics are left out."""
    assert {row.gz_topic for row in bridged(ROOT)} & {"/scout/lidar", "/model/scout/cmd_vel", "/lidar/points"} == set()


def test_it_needs_nothing_else(text):
    assert re.findall(r"<script|<link|<img|url\(|@import|https?://", text) == []


def test_a_student_gets_it_and_the_glossary():
    files = handed_out()
    assert {str(CHEAT_SHEET), "chapters/glossary.ipynb"} <= files.keys()
    readme = files["README.md"].decode()
    assert "(chapters/cheat_sheet.html)" in readme and "(chapters/glossary.ipynb)" in readme


@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium is installed")
def test_it_is_printed_on_two_pages(tmp_path):
    pdf = tmp_path / "sheet.pdf"
    options = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'profile'}"]
    command = [CHROMIUM, *options, "--no-pdf-header-footer", f"--print-to-pdf={pdf}", f"file://{ROOT / CHEAT_SHEET}"]
    subprocess.run(command, check=True, capture_output=True, timeout=300)
    assert len(PAGE.findall(pdf.read_bytes())) == 2
