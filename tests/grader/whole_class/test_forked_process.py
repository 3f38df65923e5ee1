"""Gradings are forked from a process that is ready: each is our child, sees nothing of another, and outlives it."""

import contextlib
import ctypes
import json
import os
import signal
import subprocess
import sys

import psutil
import pytest

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.whole_class.forked_process import ForkServer

PR_SET_CHILD_SUBREAPER = 36
LONG = 120  # [s] nobody waits for
# A server that imports nothing; its gradings say what they see, or do what their first argument says.
SERVER = """
import json, os, signal, sys
from gz_course.grader.whole_class import fork_server

seen = []

def course():
    what, *rest = sys.argv[1:]
    if what == "look":
        state = [*seen, *sorted(name for name in os.environ if name.startswith("MARK_"))]
        seen.append(rest[0])
        sibling = os.getsid(0) == os.getsid(os.getppid())
        print(json.dumps([state, os.getcwd(), os.getppid(), sibling, sys.argv[0]]), file=sys.stderr)
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        os.environ["MARK_" + rest[0]] = "left"
        sys.exit(1)
    if what == "wait":
        print("waits", file=sys.stderr, flush=True)
        signal.pause()
    if what == "fail":
        raise ValueError("as it was told")

import gz_course.grader.course as module
module.main = course
fork_server.load = lambda: None
if LOADING:
    exec(LOADING)
fork_server.main()
"""


@pytest.fixture
def server():
    """A server whose gradings become children of this process; `server(loading)` runs a text as it starts."""
    libc, started = ctypes.CDLL(None), []
    libc.prctl(PR_SET_CHILD_SUBREAPER, 1)

    def start(loading=""):
        started.append(ForkServer(("-c", SERVER.replace("LOADING", repr(loading)))))
        return started[-1]

    yield start
    for each in started:
        each.close()
    libc.prctl(PR_SET_CHILD_SUBREAPER, 0)


def run(server, folder, *arguments, **environment):
    folder.mkdir(exist_ok=True)
    return server.start(folder, list(arguments), dict(os.environ) | environment)


def until_it_waits(folder):
    while "waits" not in (folder / "stderr").read_text() if (folder / "stderr").exists() else True:
        os.sched_yield()


def test_a_grading_is_our_child_and_nothing_of_one_is_seen_by_the_next(server, tmp_path):
    ours, told = server(), []
    for name in ("one", "two"):
        folder = tmp_path / name
        assert run(ours, folder, "look", name, **{f"MARK_{name}_given": "1"}).wait(LONG) == 1
        told.append(json.loads((folder / "stderr").read_text()))
    assert told == [
        [[f"MARK_{name}_given"], str(tmp_path / name), os.getpid(), False, "course"] for name in ("one", "two")
    ]


def test_a_killed_server_costs_no_grading(server, tmp_path):
    ours = server()
    at_work = run(ours, tmp_path / "one", "wait")
    until_it_waits(tmp_path / "one")
    first = ours.pid
    os.kill(first, signal.SIGKILL)
    assert run(ours, tmp_path / "two", "look", "two").wait(LONG) == 1
    assert ours.pid != first and at_work.poll() is None
    assert psutil.Process(at_work.pid).cmdline()[:3] == ["course", "wait", str(tmp_path / "one")], "it shows what it is"
    os.killpg(at_work.pid, signal.SIGKILL)
    assert at_work.wait(LONG) == -signal.SIGKILL
    with pytest.raises(ProcessLookupError):
        os.kill(at_work.pid, 0)


def test_what_a_grading_raises_is_its_own_end(server, tmp_path):
    ours = server()
    assert run(ours, tmp_path / "one", "fail").wait(LONG) == 3
    assert "ValueError: as it was told" in (tmp_path / "one/stderr").read_text()
    waits = run(ours, tmp_path / "two", "wait")
    with pytest.raises(subprocess.TimeoutExpired):
        waits.wait(0.0)
    until_it_waits(tmp_path / "two")
    os.killpg(waits.pid, signal.SIGINT)  # as `end` does: a grading hears Ctrl-C, the server does not
    assert waits.wait(LONG) == 3 and "KeyboardInterrupt" in (tmp_path / "two/stderr").read_text()


def test_a_server_that_cannot_start_says_why(server, tmp_path):
    with pytest.raises(InfrastructureError, match="no such luck"):
        run(server("def load(): raise RuntimeError('no such luck')\nfork_server.load = load"), tmp_path)
    with pytest.raises(InfrastructureError, match="ended twice"):
        run(server("os._exit(1)"), tmp_path)


def test_after_the_stop_nothing_is_started(server, tmp_path):
    ours = server()
    run(ours, tmp_path / "one", "look", "one").wait(LONG)
    ours.stop()
    with pytest.raises(InterruptedError):
        run(ours, tmp_path / "two", "look", "two")
    with pytest.raises(InterruptedError):
        run(ours, tmp_path / "two", "look", "two")
    assert ours.pid is None


def test_server_and_gradings_end_with_their_starter(tmp_path):
    program = f"""
import ctypes, os, sys
from pathlib import Path
from gz_course.grader.whole_class.forked_process import ForkServer
ctypes.CDLL(None).prctl({PR_SET_CHILD_SUBREAPER}, 1)
server = ForkServer(("-c", {SERVER.replace("LOADING", "''")!r}))
grading = server.start(Path({str(tmp_path)!r}), ["wait"], dict(os.environ))
print(server.pid, grading.pid, flush=True)
os._exit(0)
"""
    done = subprocess.run([sys.executable, "-P", "-c", program], capture_output=True, text=True, timeout=LONG)
    for pid in map(int, done.stdout.split()):
        with contextlib.suppress(psutil.NoSuchProcess):
            while psutil.Process(pid).status() != psutil.STATUS_ZOMBIE:  # not ours to wait for
                os.sched_yield()
    assert len(done.stdout.split()) == 2, done.stderr
