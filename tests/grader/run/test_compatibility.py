"""A library that has changed ends a run in one clear sentence (exit 3), and not in a hang."""

import os
import subprocess
import sys

import pytest
import rclpy.client
import rclpy.executors
import rclpy.publisher

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.run import compatibility
from gz_course.grader.run.agent.course_agent import python_3, python_3_threads, rclpy_7_1
from gz_course.grader.run.agent.course_agent.self_check import misfits
from gz_course.grader.run.compatibility import check_compatibility

# Every Python of the grading begins with it.
ANOTHER_RCLPY = "import rclpy.executors; del rclpy.executors.Executor._take_client"


def test_what_is_installed_fits():
    check_compatibility()


@pytest.mark.parametrize("place", sorted(rclpy_7_1.RELIED_UPON))
def test_every_entry_is_missed_when_it_is_gone(place):
    module, _, path = place.partition(":")
    gone = f"{module}:{path}_gone"
    assert misfits({gone: rclpy_7_1.RELIED_UPON[place]}) == [f"{module}.{path}_gone is missing"]


def test_a_function_that_is_gone(monkeypatch):
    monkeypatch.delattr(rclpy.executors.Executor, "_take_client")
    with pytest.raises(InfrastructureError, match=r"rclpy\.executors\.Executor\._take_client is missing"):
        check_compatibility()


def test_a_function_that_takes_other_parameters(monkeypatch):
    monkeypatch.setattr(rclpy.publisher.Publisher, "publish", lambda self, msg, options: None)
    with pytest.raises(InfrastructureError, match=r"publish takes \(self, msg, options\) where \(self, msg\)"):
        check_compatibility()


def test_an_attribute_that_is_not_used_any_more(monkeypatch):
    monkeypatch.setattr(rclpy.client.Client, "call_async", lambda self, request: self._lock)
    with pytest.raises(InfrastructureError, match=r"call_async does not use '_pending_requests' any more"):
        check_compatibility()


def test_another_version(monkeypatch):
    monkeypatch.setattr(compatibility, "version", lambda package: "7.2.0")
    with pytest.raises(InfrastructureError, match=r"rclpy has the version 7\.2\.0, and 7\.1 is expected"):
        check_compatibility()


@pytest.mark.parametrize(
    ("table", "place"),
    [(table, place) for table in (python_3.SUBPROCESS, python_3.ASYNCIO, python_3_threads.THREADS) for place in table],
)
def test_another_python(monkeypatch, table, place):
    """Whose function has another name: those of this process are in use."""
    module, _, path = place.partition(":")
    monkeypatch.setitem(table, f"{place}_of_another", table[place])
    with pytest.raises(InfrastructureError, match=rf"this Python 3\.\d+\.\d+: {module}\.{path}_of_another is missing"):
        check_compatibility()


def test_a_grading_ends_with_exit_code_3(root, tmp_path):
    words = ["grade", "03_teleop", "--submission", str(root / "solutions/03_teleop"), "--out", str(tmp_path)]
    (tmp_path / "sitecustomize.py").write_text(ANOTHER_RCLPY)
    command = [sys.executable, "-c", "from gz_course.grader.course import main; main()", *words]
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    done = subprocess.run(command, capture_output=True, text=True, cwd=root, env=environment)
    assert done.returncode == 3
    assert "rclpy.executors.Executor._take_client is missing" in done.stderr


def test_the_agent_refuses_the_import(root):
    code = f"import sys; sys.path.insert(0, {str(root / 'grader/run/agent')!r}); import rclpy.executors\n"
    code += "del rclpy.executors.Executor._take_client\nfrom course_agent import rclpy_7_1; rclpy_7_1.install()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    last = done.stderr.strip().splitlines()[-1]
    assert last == "ImportError: this rclpy cannot be kept in step: rclpy.executors.Executor._take_client is missing"
