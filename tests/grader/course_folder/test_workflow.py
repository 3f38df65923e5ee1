"""`course ci`: the workflow file is valid, grades what was begun, and replaces nobody's own file."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from gz_course.grader.course_folder.layout import RECORD
from gz_course.grader.course_folder.workflow import MARK, PLACE, begun, install_command, write_workflow
from gz_course.grader.errors import UsageError
from gz_course.grader.exercise.pristine import STARTERS

BIN = Path(sys.executable).parent


@pytest.fixture
def mine(root, tmp_path):
    """A folder as `course init` makes it, with two exercises."""
    for name, file in (("03_teleop", "teleop_node.py"), ("04_lidar_listener", "lidar_subscriber.py")):
        shutil.copytree(root / "exercises" / name, tmp_path / "exercises" / name)
        (tmp_path / STARTERS / name).mkdir(parents=True)
        shutil.copy(root / "exercises" / name / file, tmp_path / STARTERS / name / file)
    (tmp_path / RECORD).write_text("{}")
    return tmp_path


def test_only_what_was_begun_is_graded(mine):
    assert begun(mine) == []
    with pytest.raises(UsageError, match="no exercise is begun yet"):
        write_workflow(mine, [], None)
    (mine / "exercises/03_teleop/teleop_node.py").write_text("mine")
    assert begun(mine) == ["03_teleop"]


def test_the_workflow_is_what_actions_read(mine):
    path = write_workflow(mine, ["03_teleop", "04_lidar_listener"], None)
    job = yaml.safe_load(path.read_text())["jobs"]["grade"]
    assert path == mine / PLACE
    assert job["strategy"]["matrix"]["exercise"] == ["03_teleop", "04_lidar_listener"]
    assert job["steps"][2]["run"].startswith("pip install 'gz-ros2-course==")
    assert "@" not in "".join(step.get("run", "") for step in job["steps"])
    write_workflow(mine, ["03_teleop"], None)  # its own file is replaced


def test_a_file_of_somebody_else_stays(mine):
    (mine / PLACE).parent.mkdir(parents=True)
    (mine / PLACE).write_text("name: mine\n")
    with pytest.raises(UsageError, match="was not written by `course ci`"):
        write_workflow(mine, ["03_teleop"], None)
    assert (mine / PLACE).read_text() == "name: mine\n"
    assert MARK.startswith("#")


def test_the_course_comes_from_where_the_repository_has_it(mine, root, tmp_path):
    (mine / "wheels").mkdir()
    (mine / "wheels/course-1.whl").write_text("x")
    assert install_command(mine, "wheels/course-1.whl") == "pip install './wheels/course-1.whl'"
    assert install_command(root, None) == "pip install --constraint constraints.txt --editable ."
    for wrong in ("wheels/none.whl", "/etc/passwd", "../x.whl"):
        with pytest.raises(UsageError, match=r"is no wheel in .*copy the file there"):
            install_command(mine, wrong)
    with pytest.raises(UsageError, match="holds no course"):
        install_command(tmp_path / "wheels", None)


@pytest.mark.proof
def test_linters_of_workflows_find_nothing(mine):
    path = write_workflow(mine, ["03_teleop"], None)
    for words in (["check-jsonschema", "--builtin-schema", "vendor.github-workflows"], ["zizmor", "--offline"]):
        done = subprocess.run([BIN / words[0], *words[1:], path], capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.proof
@pytest.mark.timeout(600)
def test_its_steps_grade_and_say_what_came_out(mine, root):
    shutil.copy(root / "solutions/03_teleop/teleop_node.py", mine / "exercises/03_teleop")
    steps = yaml.safe_load(write_workflow(mine, ["03_teleop"], None).read_text())["jobs"]["grade"]["steps"]
    surroundings = os.environ | {"EXERCISE": "03_teleop", "GITHUB_STEP_SUMMARY": str(mine / "summary.md")}
    surroundings["PATH"] = f"{BIN}:{surroundings['PATH']}"
    for step in steps[3:5]:
        words = ["bash", "-e", "-c", step["run"]]
        done = subprocess.run(words, cwd=mine, env=surroundings, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
    assert (mine / "summary.md").read_text().startswith("**03_teleop: 100 of 100**")
    assert json.loads((mine / "runs/report.json").read_text())["score"] == 100
