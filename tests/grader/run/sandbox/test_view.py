"""What a box shows: enough to run a node, nothing of what is to stay hidden."""

import sys
from pathlib import Path

import pytest

from gz_course.grader.run.sandbox import view as module
from gz_course.grader.run.sandbox.view import SOCKETS, SUBMISSION, Place, readable, view

ROOT = Path(__file__).parents[4]


@pytest.fixture
def places(tmp_path):
    def make():
        for name in ("submission", "door", "etc"):
            (tmp_path / name).mkdir(exist_ok=True)
        (tmp_path / "etc/passwd").touch()
        return {p.path: p for p in view(tmp_path / "submission", tmp_path / "door", tmp_path / "etc")}

    return make


def shown(places, path):
    """The place in which a path of the machine can be seen under its own name, if there is one."""
    over = [places[str(p)] for p in (path, *path.parents) if str(p) in places]
    return over[0] if over and over[0].kind == "bind" else None


def test_what_a_node_needs_is_there(places):
    found = places()
    for path in (sys.prefix, sys.base_prefix, ROOT / "sim/gz", "/usr/lib", ROOT / "grader/run/sandbox/init/main.py"):
        assert shown(found, Path(path)), path
    assert {found[path].kind for path in ("/tmp", "/dev/shm")} == {"tmpfs"}
    assert {found[str(path)].kind for path in (SUBMISSION, SOCKETS)} == {"bind"}


def test_what_is_to_stay_hidden_is_not(places):
    found = places()
    for name in (
        "solutions",
        "exercises",
        "tests",
        "chapters",
        ".git",
        "grader/score",
        "grader/grade.py",
        "grader/run/run_loop.py",
    ):
        assert shown(found, ROOT / name) is None, name
    for path in ("/etc/shadow", "/root/.ssh", "/home", "/var", "/run", "/sys"):
        assert shown(found, Path(path)) is None or str(sys.prefix).startswith(path), path


def test_a_course_below_a_folder_of_the_system_is_masked(places, monkeypatch):
    monkeypatch.setattr(module, "SYSTEM", (*module.SYSTEM, str(ROOT.parent)))  # as /usr for a course in /usr/src
    found = places()
    for name in ("solutions/02_launch/trials.toml", "exercises", "tests", ".git", "grader/score", "grader/grade.py"):
        assert shown(found, ROOT / name) is None, name
        assert not any((ROOT / name).is_relative_to(path) for path in readable(found.values())), name
    for path in (Path(sys.prefix), ROOT / "sim/gz", ROOT / "public", ROOT / "grader/run/agent"):
        assert shown(found, path), path
        assert any(path.is_relative_to(each) for each in readable(found.values())), path


def test_parents_come_first_and_every_place_has_them(places):
    found = places()
    seen = set()
    for path, place in found.items():
        above = [str(parent) for parent in Path(path).parents[:-1]]
        assert any(p in seen and found[p].kind == "bind" for p in above) or set(above) <= seen, path
        assert place.kind in ("bind", "device", "link", "folder", "mask", "proc", "tmpfs")
        seen.add(path)


def test_a_grader_that_is_installed_beside_the_libraries_is_masked(places, tmp_path, monkeypatch):
    site = tmp_path / "venv/lib/site-packages"
    package = site / "gz_course"
    for name in ("grader/run/sandbox/init", "grader/run/agent", "grader/score", "sim", "exercises/03_teleop/grading"):
        (package / name).mkdir(parents=True)
    monkeypatch.setattr(module, "_python", lambda: [tmp_path / "venv"])
    monkeypatch.setattr(module, "_package", lambda name: site.joinpath(*name.split(".")))
    monkeypatch.setattr(module.gz_course, "__file__", str(package / "__init__.py"))
    found = places()
    assert found[str(package / "grader")] == Place("mask", str(package / "grader"))
    assert found[str(package / "grader/run")].kind == "folder"
    assert shown(found, package / "grader/run/sandbox/init") and shown(found, package / "sim")
    assert shown(found, package / "grader/score") is None
    assert shown(found, package / "exercises/03_teleop/grading") is None and shown(found, package / "__init__.py")
