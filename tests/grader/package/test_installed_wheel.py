"""Where the course is installed from a wheel, the package for Gradescope holds that wheel, and works from it alone."""

import os
import subprocess
import sys
import venv
import zipfile
from importlib.metadata import PathDistribution

import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.package import installed_wheel as module
from gz_course.grader.package.installed_wheel import installed_versions, installed_wheel

METADATA = (
    "Metadata-Version: 2.4\nName: gz-ros2-course\nVersion: 1.2\nRequires-Dist: numpy\nRequires-Dist: unheard-of\n"
)
PROGRAM = "gz_course/sim/ros/prefix/lib/talker/talker"


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """A folder of packages with a small course in it, as an installer leaves it."""
    packages = tmp_path / "lib/site-packages"
    files = {
        "gz_course/grader/course.py": "def main(): ...\n",
        PROGRAM: "#!/bin/sh\n",
        "gz_course/grader/__pycache__/course.cpython-311.pyc": "",
        "gz_ros2_course-1.2.dist-info/METADATA": METADATA,
        "gz_ros2_course-1.2.dist-info/WHEEL": "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
        "gz_ros2_course-1.2.dist-info/entry_points.txt": "[console_scripts]\ncourse = gz_course.grader.course:main\n",
        "gz_ros2_course-1.2.dist-info/INSTALLER": "pip\n",
        "../../bin/course": "#!/old/python\n",
    }
    for name, text in files.items():
        (packages / name).parent.mkdir(parents=True, exist_ok=True)
        (packages / name).write_text(text)
    (packages / PROGRAM).chmod(0o755)
    record = packages / "gz_ros2_course-1.2.dist-info/RECORD"
    record.write_text("".join(f"{name},,\n" for name in (*files, "gz_ros2_course-1.2.dist-info/RECORD")))
    found = module.distribution

    def distribution(name):
        return PathDistribution(record.parent) if name == module.NAME else found(name)

    monkeypatch.setattr(module, "distribution", distribution)
    return packages


def test_an_installer_takes_it(installed, tmp_path):
    name, data = installed_wheel()
    assert name == "gz_ros2_course-1.2-py3-none-any.whl"
    (tmp_path / name).write_bytes(data)
    target = tmp_path / "target"
    command = [sys.executable, "-m", "pip", "install", "--no-index", "--no-deps", "--target", target, tmp_path / name]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    assert (target / PROGRAM).stat().st_mode & 0o111, "ros2 run starts it"
    assert (target / "gz_course/grader/course.py").read_text() == "def main(): ...\n"
    assert "/old/python" not in (target / "bin/course").read_text()
    assert installed_wheel()[1] == data


def test_all_that_it_needs_comes_in_the_version_that_is_here(installed):
    lines = installed_versions().decode().splitlines()
    assert [line for line in lines if line.startswith("numpy==")]
    assert not [line for line in lines if line.startswith(("unheard-of", module.NAME))]
    assert lines == sorted(lines)


def test_an_editable_installation_whose_folder_is_gone(installed):
    record = installed / "gz_ros2_course-1.2.dist-info/RECORD"
    record.write_text("gz_ros2_course.pth,,\ngz_ros2_course-1.2.dist-info/METADATA,,\n")
    (installed / "gz_ros2_course.pth").write_text("/gone\n")
    with pytest.raises(UsageError, match="neither a checkout nor installed from a wheel"):
        installed_wheel()


@pytest.mark.proof
@pytest.mark.timeout(1800)
def test_the_autograder_from_a_wheel_alone(root, tmp_path):
    """Build and install the wheel, package an exercise with it, set the autograder up from that, and grade."""

    def run(*command, **variables):
        kept = {key: value for key, value in os.environ.items() if not key.startswith(("ROS_", "GZ_", "COURSE_"))}
        kept.pop("PYTHONPATH", None)
        done = subprocess.run(command, cwd=tmp_path, env=kept | variables, capture_output=True, text=True, timeout=900)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]

    run(sys.executable, "-m", "pip", "wheel", "--no-deps", "--wheel-dir", tmp_path / "wheels", root)
    venv.create(tmp_path / "venv", with_pip=True)
    (wheel,) = (tmp_path / "wheels").iterdir()
    pip = tmp_path / "venv/bin/pip"
    run(pip, "install", "--constraint", root / "constraints.txt", wheel)
    run(tmp_path / "venv/bin/course", "package", "03", "--out", "autograder.zip")
    grader = tmp_path / "autograder"
    with zipfile.ZipFile(tmp_path / "autograder.zip") as packed:
        packed.extractall(grader / "source")
    (grader / "submission").mkdir()
    solved = (root / "solutions/03_teleop/teleop_node.py").read_bytes()
    (grader / "submission/teleop_node.py").write_bytes(solved)
    run("bash", grader / "source/setup.sh", AUTOGRADER_ROOT=str(grader))
    run("bash", grader / "source/run_autograder", AUTOGRADER_ROOT=str(grader))
    assert '"score": 100,' in (grader / "results/results.json").read_text()
