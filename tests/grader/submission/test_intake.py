"""Intake: what can be read is graded, what cannot is a usage error, and nothing else ever comes out."""

import dataclasses
import hashlib
import os
import warnings

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.grader.errors import RefusedError, UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.process.temporary_folder import remove
from gz_course.grader.submission import Submission
from gz_course.grader.submission.intake import LARGEST, LARGEST_FOLDER, MOST_FILES, take_in


@pytest.fixture(scope="module")
def exercise(root):
    return find_exercise("03_teleop", root)


def write(path, data):
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    return path


def test_a_file_is_taken_whatever_it_is_called(exercise, tmp_path):
    path = write(tmp_path / "mine (2).py", "x = 1\n")
    wanted = Submission(path, path.name, hashlib.sha256(b"x = 1\n").hexdigest(), None, {path.name: b"x = 1\n"})
    assert take_in(exercise, path) == wanted


def test_of_a_folder_the_file_asked_for(exercise, tmp_path):
    write(tmp_path / "other.py", "y = 1")
    path = write(tmp_path / "teleop_node.py", "x = 1")
    assert take_in(exercise, tmp_path).path == path


def test_the_one_file_of_a_folder_is_the_one_meant(exercise, tmp_path):
    path = write(tmp_path / "teleop (1).py", "x = 1")
    (tmp_path / ".git").mkdir()
    write(tmp_path / ".git/config.py", "")
    write(tmp_path / ".DS_Store", "")
    submission = take_in(exercise, tmp_path)
    assert (submission.path, submission.main, submission.files) == (path, path.name, {path.name: b"x = 1"})


def test_the_file_may_lie_deeper(exercise, tmp_path):
    (tmp_path / "week 3/lib").mkdir(parents=True)
    write(tmp_path / "notes.py", "")
    path = write(tmp_path / "week 3/teleop_node.py", "x = 1")
    write(tmp_path / "week 3/lib/slow.py", "y = 1")
    submission = take_in(exercise, tmp_path)
    assert submission.path == path
    assert submission.files == {"teleop_node.py": b"x = 1", "lib/slow.py": b"y = 1"}


def test_of_a_copy_of_the_course_the_file_of_this_exercise(exercise, tmp_path):
    for folder in ("exercises/03_teleop", "backup"):
        (tmp_path / folder).mkdir(parents=True)
        write(tmp_path / folder / "teleop_node.py", folder)
    assert take_in(exercise, tmp_path).files == {"teleop_node.py": b"exercises/03_teleop"}


def test_two_files_of_the_name_are_not_guessed_between(exercise, tmp_path):
    for folder in ("old", "new"):
        (tmp_path / folder).mkdir()
        write(tmp_path / folder / "teleop_node.py", folder)
    refused(exercise, tmp_path, "2 times", "new/teleop_node.py, old/teleop_node.py")


def test_what_would_stand_in_for_other_modules_stays_out_of_the_box(exercise, tmp_path):
    (tmp_path / "rclpy").mkdir()
    for name in ("conftest.py", "sitecustomize.py", "usercustomize.py", "numpy.py", "rclpy/__init__.py", "mine.py"):
        write(tmp_path / name, "raise SystemExit(0)")
    write(tmp_path / "teleop_node.py", "x = 1")
    assert set(take_in(exercise, tmp_path).files) == {"teleop_node.py", "mine.py"}


def test_a_folder_without_end_is_not_walked_to_it(exercise, tmp_path, monkeypatch):
    monkeypatch.setattr("gz_course.grader.submission.intake.MOST_MEMBERS", 50)
    for number in range(60):
        write(tmp_path / f"{number}.txt", "")
    refused(exercise, tmp_path, "too large", "50 files")


def test_of_a_folder_everything_goes_along_but_links(exercise, tmp_path):
    write(tmp_path / "teleop_node.py", "import speeds.slow")
    (tmp_path / "speeds").mkdir()
    write(tmp_path / "speeds/slow.py", "X = 1")
    (tmp_path / "link.py").symlink_to("/etc/passwd")
    (tmp_path / "folder").symlink_to("/etc")
    files = take_in(exercise, tmp_path).files
    assert files == {"teleop_node.py": b"import speeds.slow", "speeds/slow.py": b"X = 1"}


def test_a_folder_with_too_much_in_it(exercise, tmp_path):
    write(tmp_path / "teleop_node.py", "x = 1")
    for number in range(MOST_FILES):
        write(tmp_path / f"{number}.txt", "")
    refused(exercise, tmp_path, str(tmp_path), "too large", str(MOST_FILES))
    for number in range(MOST_FILES):
        (tmp_path / f"{number}.txt").unlink()
    for number in range(LARGEST_FOLDER // LARGEST):
        write(tmp_path / f"{number}.bin", bytes(LARGEST))
    refused(exercise, tmp_path, str(tmp_path), "too large", str(LARGEST_FOLDER))


@pytest.mark.parametrize(("name", "depth"), [("d", 1100), ("d" * 250, 20)])
def test_a_folder_with_folders_too_deep(exercise, tmp_path, name, depth):
    """As an archive with names that long is; Python itself would give up."""
    write(tmp_path / "teleop_node.py", "x = 1")
    where = os.open(tmp_path, os.O_RDONLY)
    for _ in range(depth):
        os.mkdir(name, dir_fd=where)
        where, before = os.open(name, os.O_RDONLY, dir_fd=where), where
        os.close(before)
    os.close(where)
    with pytest.raises(RefusedError, match="too deep"):
        take_in(exercise, tmp_path)
    remove(tmp_path)


def test_without_a_path_the_students_own_copy(exercise):
    assert take_in(exercise, None).path == exercise.starter.resolve()


def test_a_relative_path_becomes_absolute(exercise, tmp_path, monkeypatch):
    path = write(tmp_path / "node.py", "x = 1")
    monkeypatch.chdir(tmp_path)
    assert take_in(exercise, path.relative_to(tmp_path)).path == path


def refused(exercise, path, *words):
    with pytest.raises(UsageError) as caught:
        take_in(exercise, path)
    told = str(caught.value)
    assert [word for word in words if word not in told] == [], told
    assert "\n" not in told


def test_a_folder_without_the_file(exercise, tmp_path):
    write(tmp_path / "teleop.py", "")
    write(tmp_path / "other.py", "")
    refused(exercise, tmp_path, str(tmp_path), "teleop_node.py", "did you mean 'teleop.py'?")


def test_an_empty_folder(exercise, tmp_path):
    refused(exercise, tmp_path, "teleop_node.py", "03_teleop")


def test_a_folder_in_place_of_the_file(exercise, tmp_path):
    (tmp_path / "teleop_node.py").mkdir()
    refused(exercise, tmp_path, "teleop_node.py")


def test_a_missing_file_names_its_neighbour(exercise, tmp_path):
    write(tmp_path / "teleop_node.py", "")
    refused(exercise, tmp_path / "teleop_nod.py", "teleop_nod.py", "did you mean 'teleop_node.py'?")


def test_a_missing_file_in_a_missing_folder(exercise, tmp_path):
    refused(exercise, tmp_path / "nowhere" / "node.py", "nowhere/node.py")


def test_a_dangling_link(exercise, tmp_path):
    (tmp_path / "teleop_node.py").symlink_to(tmp_path / "gone.py")
    refused(exercise, tmp_path / "teleop_node.py", "teleop_node.py")


def test_a_link_that_goes_round(exercise, tmp_path):
    (tmp_path / "node.py").symlink_to(tmp_path / "node.py")
    refused(exercise, tmp_path / "node.py", "node.py")


def test_a_pipe_is_not_waited_for(exercise, tmp_path):
    os.mkfifo(tmp_path / "node.py")
    refused(exercise, tmp_path / "node.py", "not a regular file")


def test_a_device_is_not_read(exercise):
    from pathlib import Path

    refused(exercise, Path("/dev/zero"), "not a regular file")


def test_a_file_that_is_too_large(exercise, tmp_path):
    path = write(tmp_path / "node.py", b"#" * (LARGEST + 1))
    refused(exercise, path, str(LARGEST), str(LARGEST + 1))
    assert take_in(exercise, write(path, b"#" * LARGEST)).fault is None


def test_a_huge_file_is_refused_by_its_size_without_reading_it(exercise, tmp_path, monkeypatch):
    path = write(tmp_path / "node.py", b"")
    os.truncate(path, 1 << 40)  # sparse: takes no room
    refused(exercise, path, str(LARGEST), str(1 << 40))


def test_a_name_longer_than_any_file(exercise, tmp_path):
    refused(exercise, tmp_path / ("x" * 5000), "xxx")


def test_a_name_with_a_null(exercise, tmp_path):
    refused(exercise, tmp_path / "a\0b", "a")


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ("x = 1\ny = (\n", ["node.py, line 2", "SyntaxError"]),
        ("def f():\nreturn 1\n", ["node.py, line 2", "IndentationError", "return 1"]),
        ("if 1:\n        x = 1\n\ty = 2\n", ["node.py, line 3", "TabError"]),
        ("x = 1\nreturn\n", ["node.py, line 2", "SyntaxError"]),
        ("x = 1\nawait y\n", ["node.py, line 2", "SyntaxError"]),
        (b"x = 1\n# caf\xe9\n", ["node.py, line 2", "UTF-8"]),
        (b"# coding: klingon\nx = 1\n", ["node.py", "klingon"]),
        (b"x = 1\n\0\n", ["node.py", "null"]),
        (b"\xff\xfex\x00 \x00=\x00", ["node.py"]),
        ("(" * 5000 + ")" * 5000, ["node.py"]),
        ("-" * 200_000 + "1", ["node.py"]),
        ("x" + ".x" * 100_000, ["node.py"]),
    ],
)
def test_what_is_not_python_is_the_students_fault_with_its_place(exercise, tmp_path, data, words):
    fault = take_in(exercise, write(tmp_path / "node.py", data)).fault
    assert fault is not None
    assert [word for word in words if word not in fault] == [], fault
    assert "\n" not in fault
    assert len(fault) < 500, "one sentence, not the file"


@pytest.mark.parametrize("data", [b"", b"\n", b"\xef\xbb\xbfx = 1\n", b"x = 1\r\ny = 2\r\n", b"x = '\\d'\n"])
def test_what_is_python(exercise, tmp_path, data):
    assert take_in(exercise, write(tmp_path / "node.py", data)).fault is None


PYTHON_LIKE = st.lists(
    st.sampled_from(
        ["def f(", "):\n", "  ", "\t", "x", "=", "1e999", "'", '"""', "\\", "\n", "\0", "#", "(", "[", "{"]
    ),
    max_size=30,
).map("".join)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(st.one_of(st.binary(max_size=400), PYTHON_LIKE.map(str.encode), st.text(max_size=100).map(str.encode)))
def test_arbitrary_bytes_are_taken_or_are_a_fault(exercise, tmp_path, data):
    submission = take_in(exercise, write(tmp_path / "node.py", data))
    assert submission.sha256 == hashlib.sha256(data).hexdigest()
    assert submission.fault is None or (submission.fault and submission.fault.isprintable())
    if submission.fault is None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an odd escape in a string is Python, too
            compile(data, "node.py", "exec")


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(st.binary(min_size=1, max_size=300))
def test_arbitrary_names_are_only_ever_usage_errors(exercise, tmp_path, name):
    path = tmp_path / os.fsdecode(name)
    try:
        take_in(exercise, path)
    except UsageError as error:
        assert str(error)


@pytest.fixture
def of_two_files(exercise):
    return dataclasses.replace(exercise, files=("robot/robot.sdf",))


def test_further_files_come_with_the_folder_or_lie_beside_the_file(of_two_files, tmp_path):
    path = write(tmp_path / "teleop_node.py", "x = 1")
    (tmp_path / "robot").mkdir()
    write(tmp_path / "robot/robot.sdf", "<sdf/>")
    wanted = {"teleop_node.py": b"x = 1", "robot/robot.sdf": b"<sdf/>"}
    alone, folder = take_in(of_two_files, path), take_in(of_two_files, tmp_path)
    assert alone.files == folder.files == wanted
    before = alone.sha256
    write(tmp_path / "robot/robot.sdf", "<sdf></sdf>")
    assert take_in(of_two_files, path).sha256 != before


def test_a_missing_further_file_is_named(of_two_files, tmp_path):
    write(tmp_path / "teleop_node.py", "x = 1")
    write(tmp_path / "robot.sdf", "<sdf/>")
    with pytest.raises(UsageError, match=r"without robot/robot\.sdf: .*hand them in together.*robot\.sdf"):
        take_in(of_two_files, tmp_path)


def test_a_link_is_not_taken_from_beside_a_file(of_two_files, tmp_path):
    path = write(tmp_path / "teleop_node.py", "x = 1")
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot/robot.sdf").symlink_to("/etc/passwd")
    with pytest.raises(UsageError, match=r"without robot/robot\.sdf"):
        take_in(of_two_files, path)


def test_a_further_file_in_python_is_judged_too(exercise, tmp_path):
    path = write(tmp_path / "teleop_node.py", "x = 1")
    write(tmp_path / "driver.py", "def (")
    assert "driver.py, line 1" in str(take_in(dataclasses.replace(exercise, files=("driver.py",)), path).fault)


def test_what_grades_an_exercise_is_no_part_of_a_submission(exercise, tmp_path):
    for name in ("teleop_node.py", "grading/exercise.toml", "grading/checks.py", "grading_of_maps/own.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("x = 1")
    assert set(take_in(exercise, tmp_path).files) == {"teleop_node.py", "grading_of_maps/own.py"}
    (tmp_path / "grading/exercise.toml").unlink()
    assert "grading/checks.py" in take_in(exercise, tmp_path).files, "a folder of the student's that is called so"
