"""What grading never opens is removed, and what is asked for without it is answered in one sentence."""

import sys

import pytest

from gz_course.grader.tools import slim
from gz_course.sim.show.rviz2.viewer import ViewerError, binary


def test_only_what_is_named_goes(tmp_path, monkeypatch, capsys):
    package = tmp_path / "fat_package"
    (package / "tests").mkdir(parents=True)
    for name in ("__init__.py", "libgood.so", "libviewer.so.1", "tests/test_it.py"):
        (package / name).write_bytes(bytes(1_500_000))
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(slim, "UNUSED", {"fat_package": ("libviewer*", "tests", "gone*"), "not_installed": ("*",)})
    environment = tmp_path / "environment"
    for name in ("python3.11", "rcl"):
        (environment / "include" / name).mkdir(parents=True)
    monkeypatch.setattr(sys, "prefix", str(environment))
    slim.main()
    assert [path.name for path in environment.glob("include/*")] == ["python3.11"]
    assert sorted(path.name for path in package.iterdir()) == ["__init__.py", "libgood.so"]
    assert capsys.readouterr().out == "3 MB removed; grading needs none of it.\n"
    slim.main()
    assert capsys.readouterr().out.startswith("0 MB removed")


def test_without_the_viewer_there_is_one_sentence(tmp_path, monkeypatch):
    assert binary().is_file()
    (tmp_path / "rerun_cli").mkdir()
    (tmp_path / "rerun_cli/__init__.py").touch()
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "rerun_cli", raising=False)
    with pytest.raises(ViewerError, match=r"Rerun's viewer is not installed; .*rerun-sdk"):
        binary()
