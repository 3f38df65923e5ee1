"""The end of a child is awaited in the kernel."""

import os
import subprocess
import time

import pytest

from gz_course.sim import orphan_watch
from gz_course.sim.child_end import await_end


@pytest.fixture
def frozen(monkeypatch):
    """Let every sleep of Python and every wait of `subprocess` with a deadline fail."""

    def fail(*_, **__):
        raise AssertionError("this takes time of the process, not of the machine")

    wait = subprocess.Popen.wait
    monkeypatch.setattr(time, "sleep", fail)
    monkeypatch.setattr(subprocess.Popen, "wait", lambda self, timeout=None: wait(self) if timeout is None else fail())


def test_it_is_told_by_the_kernel(frozen):
    with subprocess.Popen(["sh", "-c", "read line; exit 3"], stdin=subprocess.PIPE) as process:
        assert await_end(process, 0.01) is None
        process.stdin.close()
        assert await_end(process, 300) == 3
        assert await_end(process, 300) == 3


def test_the_guard_of_a_launch_is_awaited_so(frozen):
    with subprocess.Popen(["sleep", "1000"], process_group=0) as child:
        orphan_watch.watch(child.pid)
        shell = orphan_watch._watch._shell
        orphan_watch.unwatch(child.pid)
        assert shell.returncode == 0
        child.kill()


def test_old_kernels_have_no_pidfd(monkeypatch):
    def refuse(pid):
        raise PermissionError

    monkeypatch.setattr(os, "pidfd_open", refuse)
    with subprocess.Popen(["sh", "-c", "read line; exit 3"], stdin=subprocess.PIPE) as process:
        assert await_end(process, 0.01) is None
        process.stdin.close()
        assert await_end(process, 300) == 3


def test_an_end_that_somebody_else_has_seen():
    with subprocess.Popen(["true"]) as process:
        os.waitpid(process.pid, 0)
        assert await_end(process, 300) == 0
