"""The Gradescope package, unpacked as Gradescope does it, grades, and always leaves a results.json."""

import hashlib
import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.package.gradescope import package

FILE = "teleop_node.py"


@pytest.fixture(scope="module")
def archive(root, tmp_path_factory):
    path = tmp_path_factory.mktemp("package") / "autograder.zip"
    package(find_exercise("03_teleop", root), path)
    return path


@pytest.fixture
def autograder(archive, tmp_path, root):
    """A scratch /autograder with everything in its place; call it with files to submit."""
    with zipfile.ZipFile(archive) as packed:
        packed.extractall(tmp_path / "source")
    shutil.copy(tmp_path / "source/run_autograder", tmp_path / "run_autograder")
    (tmp_path / "run_autograder").chmod(0o755)
    (tmp_path / "venv").symlink_to(Path(sys.prefix))
    (tmp_path / "submission").mkdir()
    (tmp_path / "tmp").mkdir()

    def run(files, **variables):
        for name, data in files.items():
            (tmp_path / "submission" / name).write_bytes(data)
        course = tmp_path / "source/course"
        kept = {key: value for key, value in os.environ.items() if not key.startswith(("ROS_", "GZ_", "COURSE_"))}
        environment = kept | {
            "AUTOGRADER_ROOT": str(tmp_path),
            "TMPDIR": str(tmp_path / "tmp"),
            "PYTHONPATH": str(course / "public"),  # as if this had been installed, not the checkout
        }
        done = subprocess.run(
            [tmp_path / "run_autograder"], cwd=tmp_path, env=environment | variables, capture_output=True, timeout=600
        )
        assert done.returncode == 0, done.stderr
        return json.loads((tmp_path / "results/results.json").read_text())

    return run


def test_what_is_in_it(archive, root):
    with zipfile.ZipFile(archive) as packed:
        names = set(packed.namelist())
        for program in ("setup.sh", "run_autograder"):
            assert packed.getinfo(program).external_attr >> 16 & 0o111, f"{program} can be run"
            text = packed.read(program).decode()
            assert "@" not in text.replace('"$@"', "") and text.startswith("#!"), f"{program} is filled in"
            assert subprocess.run(["bash", "-n"], input=text.encode()).returncode == 0
        program = "course/sim/ros/prefix/lib/robot_state_publisher/robot_state_publisher"
        assert packed.getinfo(program).external_attr >> 16 & 0o111, "ros2 run starts it"
        assert not packed.getinfo("course/LICENSE").external_attr >> 16 & 0o111
    assert {"course/pyproject.toml", "course/README.md", f"course/exercises/03_teleop/{FILE}"} <= names
    assert {"course/grader/course.py", "course/sim/gz/sim/world.py"} <= names
    assert not [name for name in names if name.startswith("course/solutions") and name.endswith(".py")]
    assert not [name for name in names if name.startswith("course/exercises") and "03_teleop" not in name]
    assert not [name for name in names if "__pycache__" in name or "/tests/" in name]


def test_hidden_trials_come_along_and_solutions_do_not(root, tmp_path):
    names = package(find_exercise("04_lidar_listener", root), tmp_path / "a.zip")
    assert "course/solutions/04_lidar_listener/trials.toml" in names
    assert [name for name in names if name.startswith("course/solutions") and name.endswith(".py")] == []
    with zipfile.ZipFile(tmp_path / "a.zip") as packed:
        assert "--trials all" in packed.read("run_autograder").decode()


def test_the_same_exercise_gives_the_same_bytes(archive, root, tmp_path):
    package(find_exercise("03_teleop", root), tmp_path / "again.zip")
    first, second = (hashlib.sha256(path.read_bytes()).hexdigest() for path in (archive, tmp_path / "again.zip"))
    assert first == second


@pytest.mark.proof
def test_a_right_submission(autograder, solved):
    results = autograder({FILE: solved})
    assert results["score"] == 100
    assert len(results["tests"]) == 6 and all(test["status"] == "passed" for test in results["tests"])


@pytest.fixture(scope="module")
def solved(root):
    return (root / "solutions/03_teleop" / FILE).read_bytes()


def test_a_submission_that_cannot_be_read(autograder):
    results = autograder({"a.py": b"", "b.py": b""})
    assert results["score"] == 0 and results["extra_data"]["outcome"] == "protocol"
    assert "could not be read" in results["output"] and f"holds no {FILE}" in results["output"]


@pytest.mark.proof
def test_a_fault_that_is_not_the_students(autograder, solved, tmp_path):
    manifest = tmp_path / "source/course/exercises/03_teleop/grading/exercise.toml"
    manifest.write_text(manifest.read_text().replace("lidar_room.sdf", "nowhere.sdf"))
    results = autograder({FILE: solved})
    assert results["extra_data"]["outcome"] == "infra"
    assert "not your fault" in results["output"] and "nowhere.sdf" in results["output"]


def test_without_the_course_there_are_still_results(autograder, solved, tmp_path):
    (tmp_path / "venv").unlink()
    results = autograder({FILE: solved})
    assert results["extra_data"]["outcome"] == "infra" and "not your fault" in results["output"]


def test_the_command(course, tmp_path, root):
    outcome = course("package", "03", "--out", tmp_path / "x/autograder.zip")
    assert outcome.code == 0 and zipfile.is_zipfile(tmp_path / "x/autograder.zip"), outcome.output
    for arguments, words in ((["--out", tmp_path], "is a folder"), (["--out", "a.zip", "--trials", "b"], "no file b")):
        outcome = course("package", "03", *arguments)
        assert outcome.code == 2 and words in outcome.words
    assert not (tmp_path / "a.zip").exists()


def test_it_demands_level_b_unless_another_is_named(root, tmp_path):
    for options, level in (({}, "B"), ({"demand": "C"}, "C")):
        package(find_exercise("03_teleop", root), tmp_path / "a.zip", **options)
        with zipfile.ZipFile(tmp_path / "a.zip") as archive:
            assert f"--demand {level}" in archive.read("run_autograder").decode()
            assert f"a sandbox of level {level} or better" in archive.read("setup.sh").decode()


def test_a_sandbox_level_that_does_not_exist(root, tmp_path):
    with pytest.raises(UsageError, match="no sandbox level"):
        package(find_exercise("03_teleop", root), tmp_path / "a.zip", demand="Z")
