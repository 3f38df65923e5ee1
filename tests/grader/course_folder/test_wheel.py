"""The course as a wheel: built twice it is the same, and installed from the file it grades as the clone does."""

import hashlib
import json
import os
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

LARGEST = 700  # [MB] of an environment for grading

pytestmark = [pytest.mark.proof, pytest.mark.timeout(1800)]


def run(*words, cwd, **kept):
    home = {"HOME": str(cwd), "PATH": "/usr/bin:/bin", "LANG": "C.UTF-8"}
    pip = {name: value for name, value in os.environ.items() if name.startswith("PIP_")}
    done = subprocess.run([*map(str, words)], cwd=cwd, env=home | pip | kept, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


@pytest.fixture(scope="module")
def built(root, tmp_path_factory):
    """Wheel and sdist, built twice from the files that git knows, with different dates."""
    folder = tmp_path_factory.mktemp("built")
    found = []
    for number, date in enumerate(("202401010000", "202502020202")):
        copy = folder / f"copy {number}"
        subprocess.run(["git", "clone", "-q", root, copy], check=True)
        subprocess.run(f"find . -exec touch -t {date} {{}} +", cwd=copy, shell=True, check=True)
        code, told = run(sys.executable, "-m", "build", "--outdir", folder / str(number), copy, cwd=folder)
        assert code == 0, told[-3000:]
        found.append(sorted((folder / str(number)).iterdir()))
    return found


def test_two_builds_are_the_same_and_hold_no_solution(built):
    digests = [[hashlib.sha256(path.read_bytes()).hexdigest() for path in paths] for paths in built]
    assert len(digests[0]) == 2 and digests[0] == digests[1]
    wheel = next(path for path in built[0] if path.suffix == ".whl")
    sdist = next(path for path in built[0] if path.suffix == ".gz")
    assert wheel.stat().st_size < 8_000_000
    with zipfile.ZipFile(wheel) as packed, tarfile.open(sdist) as source:
        names = packed.namelist() + source.getnames()
    parts = {part for name in names for part in Path(name).parts[:3]}
    assert not parts & {"solutions", "tests", ".ci"}
    assert {f"gz_course/exercises/03_teleop/{name}" for name in ("README.md", "grading/exercise.toml")} <= set(names)
    assert "gz_course/chapters/03_teleop/03_teleop.ipynb" in names


def test_installed_from_the_file_it_grades_as_the_clone_does(built, root, tmp_path):
    here = tmp_path / "a füld"  # a path with a blank and an umlaut
    here.mkdir()
    wheel = next(path for path in built[0] if path.suffix == ".whl")
    code, told = run(sys.executable, "-m", "venv", here / ".venv", cwd=here)
    assert code == 0, told
    bin = here / ".venv/bin"
    code, told = run(bin / "pip", "-q", "install", "-c", root / "constraints.txt", wheel, cwd=here)
    assert code == 0, told[-3000:]

    code, told = run(bin / "course", "init", "my course", cwd=here)
    assert code == 0 and "exercises and their chapters" in told, told
    mine = here / "my course"
    assert run(bin / "course", "update", cwd=mine) == (0, f"{mine} is up to date.\n")
    code, told = run(bin / "python", "-c", "import gz_course, launch; print(gz_course.__path__, launch)", cwd=mine)
    assert code == 0 and str(root) not in told, told

    words = ("grade", "03_teleop", "--submission", root / "solutions/03_teleop", "--json", "out.json", "--no-page")
    code, told = run(bin / "course", *words, "--out", "runs", cwd=mine)
    assert code == 0, told
    in_clone = tmp_path / "clone"
    in_clone.mkdir()
    code, told = run(
        Path(sys.executable).with_name("course"), *words, "--out", "runs", cwd=in_clone, COURSE_ROOT=str(root)
    )
    assert code == 0, told
    reports = [json.loads((folder / "out.json").read_text()) for folder in (mine, in_clone)]
    assert reports[0]["score"] == reports[1]["score"] == 100
    assert reports[0]["truth_sha256"] == reports[1]["truth_sha256"]

    # What grading never opens can go; the rest grades as before.
    code, told = run(bin / "python", "-m", "gz_course.grader.tools.slim", cwd=mine)
    assert code == 0 and "MB removed" in told, told
    code, told = run("du", "-sm", here / ".venv", cwd=mine)
    assert int(told.split()[0]) <= LARGEST
    code, told = run(bin / "course", *words, "--out", "runs", cwd=mine)
    assert code == 0, told
    assert json.loads((mine / "out.json").read_text())["truth_sha256"] == reports[1]["truth_sha256"]


@pytest.mark.parametrize("version", ["3.8", "3.9", "3.10", "3.15"])
def test_on_another_python_pip_succeeds_and_the_command_says_where_to_go(built, tmp_path, version):
    """With a real one: pyenv's, or that of the system."""
    pythons = [*Path.home().glob(f".pyenv/versions/{version}.*/bin/python"), shutil.which(f"python{version}")]
    if not (python := next(filter(None, pythons), None)):
        pytest.skip(f"there is no Python {version} here")
    wheel = next(path for path in built[0] if path.suffix == ".whl")
    assert run(python, "-m", "venv", tmp_path / ".venv", cwd=tmp_path)[0] == 0
    code, told = run(tmp_path / ".venv/bin/pip", "install", wheel, cwd=tmp_path)
    assert code == 0, told
    code, told = run(tmp_path / ".venv/bin/course", "init", "mine", cwd=tmp_path)
    assert code == 2 and told.count("\n") == 1
    assert told.startswith(f"course: the course does not run on Python {version}: it needs Linux")
    assert Path(told.split("; see ")[1].strip()).read_text().startswith("# Windows, Mac, and other machines")
