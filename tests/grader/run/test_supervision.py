"""A grading in a process of its own: what comes back, what ends it, and that nothing of it is left."""

import functools
import signal
import subprocess
import sys
import time

import psutil
import pytest

from gz_course.grader.errors import InfrastructureError, UsageError
from gz_course.grader.run import supervision, watchdog
from gz_course.grader.run.supervision import Supervised
from gz_course.tests.descriptors import left_open, own_descriptors
from gz_course.tests.grader.run.supervised_jobs import (
    asks_for_all_memory,
    complains,
    computes,
    crashes,
    daemon,
    doubled,
    fills_memory,
    hears,
    sleeps,
    starts_one_that_computes,
)

HOST = """
import signal
from gz_course.grader.process.interruption import end_on
from gz_course.grader.run.supervision import Supervised
from gz_course.tests.descriptors import left_open, own_descriptors
from gz_course.tests.grader.run.supervised_jobs import {job}
end_on(signal.SIGTERM)
print("ready", flush=True)
Supervised([{job}], 1.0).run()
"""


@pytest.fixture(autouse=True)
def nothing_is_left():
    before = set(psutil.Process().children(recursive=True))
    descriptors = own_descriptors()
    yield
    assert set(psutil.Process().children(recursive=True)) <= before  # one of an earlier test may end meanwhile
    assert left_open(descriptors) == {}


@pytest.fixture
def impatient(monkeypatch):
    for name in (
        "OWN_CPU_SECONDS",
        "OWN_CPU_FACTOR",
        "CPU_SECONDS",
        "CPU_FACTOR",
        "BOX_CPU_SECONDS",
        "BOX_CPU_FACTOR",
        "LONGEST_WAIT",
    ):
        monkeypatch.setattr(watchdog, name, 1.0)
    monkeypatch.setattr(watchdog, "MOST_MEMORY", 400 << 20)


@pytest.fixture(params=["fork", "new Python"])
def either_way(request, monkeypatch):
    modules = set() if request.param == "fork" else {"os"}
    monkeypatch.setattr(supervision, "WITH_THREADS", modules)


def run(*jobs):
    return Supervised(jobs, 1.0).run()


def test_results_come_in_order(either_way):
    assert run(*(functools.partial(doubled, number) for number in range(3))) == ([0, 2, 4], None)


def test_what_a_job_raises_is_raised(either_way):
    with pytest.raises(UsageError, match="this is no submission"):
        run(functools.partial(doubled, 1), complains)


@pytest.mark.parametrize(
    ("job", "outcome", "words"),
    [
        (computes, "timeout", "processor time and had come no further than 0.00 s"),
        pytest.param(hears, "timeout", "Dealing with what your program sent took", marks=pytest.mark.proof),
        pytest.param(starts_one_that_computes, "timeout", "What you started had used", marks=pytest.mark.proof),
        (sleeps, "timeout", "simulated time stood still"),
        (fills_memory, "memory", "of memory"),
        (asks_for_all_memory, "memory", "too much memory"),
        (functools.partial(crashes, signal.SIGSEGV, True), "student_error", "The simulator crashed (SIGSEGV)"),
        (functools.partial(crashes, signal.SIGKILL, True), "memory", "all the memory"),
    ],
)
def test_too_much_is_an_outcome_with_a_sentence(impatient, job, outcome, words):
    results, broken = run(functools.partial(doubled, 1), job)
    assert (results, broken.job, broken.outcome) == ([2], 1, outcome)
    assert words in broken.sentence


def test_a_machine_that_is_far_too_busy_is_no_fault_of_the_submission(monkeypatch):
    monkeypatch.setattr(watchdog, "wall_limit", lambda duration: 0.5)
    with pytest.raises(InfrastructureError, match=r"this machine is too busy: 0.00 s of simulated time took"):
        run(sleeps)


def test_a_crash_before_anything_was_handed_in_is_ours():
    with pytest.raises(InfrastructureError, match="SIGSEGV"):
        run(functools.partial(crashes, signal.SIGSEGV, False))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("job", [computes, sleeps, daemon, starts_one_that_computes])
def test_an_interrupt_ends_it_and_all_it_started(job, number, tmp_path):
    code = HOST.format(job=job.__name__)
    host = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True
    )
    try:
        assert host.stdout.readline() == b"ready\n"
        deadline = time.monotonic() + 120
        needed = 1 if job in (computes, sleeps) else 2
        while len(started := psutil.Process(host.pid).children(recursive=True)) < needed:
            assert time.monotonic() < deadline
            time.sleep(0.01)
        host.send_signal(number)
        assert host.wait(120) not in (0, None)
        assert psutil.wait_procs(started, timeout=120)[1] == []
    finally:
        host.kill()
        host.wait()
        host.stdout.close()
