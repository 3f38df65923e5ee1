"""Machines that the course does not run on get one sentence, also where none of its dependencies is installed."""

import ast
import platform
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from gz_course.sim import machine
from gz_course.sim.machine import what_is_wrong

ROOT = Path(__file__).parents[2]
FINE = ("Linux", "x86_64", (2, 36), "CPython", (3, 11))
OTHERS = [
    (("Darwin", "arm64", (), "CPython", (3, 12)), "macOS"),
    (("Windows", "AMD64", (), "CPython", (3, 12)), "Windows"),
    (("Linux", "aarch64", (2, 36), "CPython", (3, 12)), "Linux on aarch64"),
    (("Linux", "x86_64", (), "CPython", (3, 12)), "Linux without glibc (musl)"),
    (("Linux", "x86_64", (2, 17), "CPython", (3, 12)), "Linux with glibc 2.17"),
    (("Linux", "x86_64", (2, 36), "CPython", (3, 10)), "Python 3.10"),
    (("Linux", "x86_64", (2, 36), "CPython", (3, 15)), "Python 3.15"),
    (("Linux", "x86_64", (2, 36), "free-threaded CPython", (3, 14)), "free-threaded Python 3.14"),
    (("Linux", "x86_64", (2, 36), "PyPy", (3, 11)), "PyPy 3.11"),
]


@pytest.mark.parametrize(("given", "wrong"), OTHERS, ids=[wrong for _, wrong in OTHERS])
def test_what_is_wrong(given, wrong):
    assert what_is_wrong(*given) == wrong


def test_what_is_fine():
    assert what_is_wrong(*FINE) == what_is_wrong(*FINE[:-1], (3, 14)) == ""


def test_one_sentence_that_names_the_page(monkeypatch, capsys):
    machine.require("course")  # this machine
    monkeypatch.setattr(platform, "system", lambda: "Darwin")
    with pytest.raises(SystemExit) as ended:
        machine.require("course")
    told = capsys.readouterr().err
    assert ended.value.code == 2 and told.count("\n") == 1
    assert told.startswith("course: the course does not run on macOS: it needs Linux on x86-64")
    page = Path(told.split("; see ")[1].strip())
    assert page == ROOT / "docs/windows_and_mac.md" and page.is_file()


def test_the_commands_need_nothing_but_python():
    """Neither the dependencies nor other modules of the course are there when the sentence is printed."""
    code = (
        "import sys, platform; platform.system = lambda: 'Windows'\n"
        f"sys.path[:0] = [{str(ROOT / 'public')!r}]\n"
        "from gz_course.grader.__main__ import main; main()"
    )
    done = subprocess.run([sys.executable, "-I", "-S", "-c", code], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("course: the course does not run on Windows") and done.stderr.count("\n") == 1


FIRST = ["public/gz_course/__init__", "sim/__init__", "sim/machine", "grader/__init__", "grader/__main__"]


@pytest.mark.parametrize("module", FIRST)
def test_old_pythons_can_read_what_prints_it(module):
    text = (ROOT / f"{module}.py").read_text()
    ast.parse(text, feature_version=(3, 6))
    assert "from __future__ import annotations" not in text, "Python 3.6 has it not"


@pytest.mark.parametrize(("given", "wrong"), [(FINE, ""), *OTHERS])
def test_pip_takes_the_dependencies_where_the_course_runs(given, wrong):
    """Markers tell all of it apart, except the C library and a build without the global lock."""
    (asked,) = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    system, processor, _, python, version = given
    environment = {
        "sys_platform": {"Linux": "linux", "Darwin": "darwin", "Windows": "win32"}[system],
        "platform_machine": processor,
        "implementation_name": python.removeprefix("free-threaded ").lower(),
        "python_version": ".".join(map(str, version)),
    }
    marker = Requirement(asked).marker
    assert marker is not None
    assert marker.evaluate(environment) == (not wrong or "glibc" in wrong or "free" in wrong)
