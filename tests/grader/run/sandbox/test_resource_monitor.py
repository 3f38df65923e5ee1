"""Limits of a whole submission: what breaks them is found out and ended, what does not is left alone."""

import ctypes
import os
import subprocess
import sys
import threading
from functools import partial

import psutil
import pytest

from gz_course.grader.process.temporary_folder import remove
from gz_course.grader.run.sandbox import resource_monitor as module
from gz_course.grader.run.sandbox.resource_monitor import DISK, MEMORY, PROCESSES, ResourceMonitor, descendants

DEADLINE = 120.0
FAMILY = """
import os, sys, time
for _ in range(int(sys.argv[1])):
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            hoard = bytearray(b"x" * int(sys.argv[2]))
            os.write(1, b".")
            time.sleep(600)
        os._exit(0)
os.write(1, b".")
time.sleep(600)
"""


@pytest.fixture
def family():
    """Start a process with some grandchildren; `family(3, size)` returns when all have their memory."""
    started = []

    def start(children, size=0):
        process = subprocess.Popen(
            [sys.executable, "-I", "-S", "-c", FAMILY, str(children), str(size)], stdout=subprocess.PIPE
        )
        started.append(process)
        while children >= 0:
            children -= len(process.stdout.read(1))
        return process

    # Orphans of a family are ours, as they are the grader's.
    ctypes.CDLL(None).prctl(36, 1)
    yield start
    for process in started:
        process.kill()
        process.communicate()


def broken(process, apart=frozenset(), **more):
    """Watch what this process of the tests has started, `apart` left out, until a limit is broken; which one."""
    ended = threading.Event()

    def kill():
        process.kill()
        ended.set()

    watch = ResourceMonitor(os.getpid(), kill, apart, **more)
    try:
        assert ended.wait(DEADLINE)
    finally:
        watch.close()
    return watch.broken


@pytest.fixture
def others():
    """What ran before the test."""
    return frozenset(descendants(os.getpid()))


def test_memory_of_all_together(others, family, monkeypatch):
    monkeypatch.setattr(module, "MOST_MEMORY", 100 << 20)
    process = family(3, 40 << 20)
    orphan_or_not = set(descendants(os.getpid())) - others
    assert broken(process, others) == MEMORY
    _, alive = psutil.wait_procs([psutil.Process(p) for p in orphan_or_not if psutil.pid_exists(p)], DEADLINE)
    assert [p for p in alive if p.status() != psutil.STATUS_ZOMBIE] == []


def test_many_processes(others, family, monkeypatch):
    monkeypatch.setattr(module, "MOST_PROCESSES", 3)
    process = family(0)
    more = [subprocess.Popen(["sleep", "600"]) for _ in range(3)]
    assert broken(process, others) == PROCESSES
    for each in more:  # whoever belongs to it goes with it
        assert each.wait(DEADLINE) == -9


def test_a_full_folder(others, family, tmp_path):
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep/file").write_bytes(b"x" * 100_000)
    assert broken(family(0), others, folder=tmp_path, most_bytes=50_000, most_files=100) == DISK


def test_many_files(others, family, tmp_path):
    for number in range(20):
        (tmp_path / str(number)).touch()
    assert broken(family(0), others, folder=tmp_path, most_bytes=1 << 30, most_files=10) == DISK


@pytest.mark.parametrize(
    ("name", "depth", "files", "answer"), [("d", 400, 300, DISK), ("d", 400, 500, None), ("d" * 250, 20, 99, DISK)]
)
def test_folders_in_folders_beyond_count(family, tmp_path, request, name, depth, files, answer):
    """Deeper than Python can call itself, and deeper than a path is long."""
    where = os.open(tmp_path, os.O_RDONLY)
    for _ in range(depth):
        os.mkdir(name, dir_fd=where)
        where, before = os.open(name, os.O_RDONLY, dir_fd=where), where
        os.close(before)
    os.close(where)
    request.addfinalizer(partial(sys.setrecursionlimit, sys.getrecursionlimit()))
    sys.setrecursionlimit(300)
    process = family(0)
    watch = ResourceMonitor(process.pid, process.kill)
    watch.close()
    watch._folder, watch._most_bytes, watch._most_files = tmp_path, 1 << 30, files
    assert watch._look() == answer
    remove(tmp_path)


def test_what_keeps_to_the_limits_is_left_alone(family, tmp_path):
    process = family(0)
    watch = ResourceMonitor(process.pid, process.kill, folder=tmp_path, most_bytes=1, most_files=1)
    assert watch._look() is None
    watch.close()
    assert watch.broken is None and process.poll() is None


def test_descendants_are_found_and_zombies_are_none(family):
    process = family(0)
    child = subprocess.Popen(["sleep", "600"])
    ended = subprocess.Popen(["true"])
    os.waitid(os.P_PID, ended.pid, os.WEXITED | os.WNOWAIT)
    found = descendants(os.getpid())
    assert {process.pid, child.pid} <= set(found) and ended.pid not in found
    assert child.pid not in descendants(os.getpid(), frozenset({child.pid}))
    child.kill()
    child.wait()
    ended.wait()
