"""A class on several machines: workers die, join late, have other versions, the scheduler starts again.

However it goes, the gradebook is the one of a single machine, byte for byte.
"""

import subprocess
import time

import psutil
import pytest

from gz_course.tests.grader.whole_class.machines import COURSE, NO_SANDBOX, Network

pytest.importorskip("distributed")
pytestmark = [pytest.mark.proof, pytest.mark.timeout(1800)]

FILE = "teleop_node.py"
DEADLINE = 600.0  # [s] for anything that is waited for


@pytest.fixture(scope="module")
def submissions(tmp_path_factory, solved, root):
    """Fourteen: what earns everything, something and nothing, and what cannot be read."""
    folder = tmp_path_factory.mktemp("class")
    variants = sorted((root / "solutions/03_teleop").glob(f"*/*/{FILE}"))[:6]
    texts = {f"{path.parent.name}/{FILE}": path.read_bytes() for path in variants}
    texts |= {f"student {n}/{FILE}": solved + f"\n# {n}\n".encode() for n in range(6)}
    texts |= {f"eve/{FILE}": b"x = (", "sue/notes.txt": b""}
    for name, data in texts.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(data)
    assert len(texts) == 14
    return folder


@pytest.fixture(scope="module")
def environment(short_course, course_environment):
    return lambda folder: course_environment(folder, COURSE_ROOT=str(short_course))


@pytest.fixture(scope="module")
def alone(tmp_path_factory, submissions, environment):
    """The gradebook of one machine."""
    folder = tmp_path_factory.mktemp("alone")
    command = [*COURSE, "grade-all", "03_teleop", str(submissions), "--out", str(folder / "out")]
    subprocess.run(command, cwd=folder, env=environment(folder), check=True, capture_output=True, timeout=DEADLINE)
    return (folder / "out/gradebook.csv").read_bytes()


@pytest.fixture
def network(tmp_path, environment):
    made = Network(tmp_path, environment)
    try:
        made.build()
        yield made
    finally:
        made.close()


def until(condition, process, what):
    """Wait until a condition holds, while a process must run."""
    end = time.monotonic() + DEADLINE
    while not condition():
        assert process.poll() is None, f"{what} did not come: {process.told.read_text()}"
        assert time.monotonic() < end, f"{what} did not come in time: {process.told.read_text()}"
        psutil.wait_procs([psutil.Process(process.pid)], timeout=0.05)


def lines(folder):
    journal = folder / "journal.jsonl"
    return journal.read_bytes().count(b"\n") if journal.exists() else 0


def grades(worker):
    """Return whether a worker grades now: it has a child."""
    return worker.poll() is None and bool(psutil.Process(worker.pid).children(recursive=True))


def done(process):
    return process.wait(DEADLINE), process.told.read_text()


def test_workers_die_join_late_and_differ(network, submissions, alone, tmp_path):
    network.start_scheduler()
    dies = network.start_worker("a")
    out = tmp_path / "out"
    run = network.grade_all(submissions, out)
    until(lambda: lines(out) >= 3 and grades(dies), run, "the third result")
    dies.kill()  # in the middle of a grading; nobody is left to grade
    other = network.start_other_worker("b")
    until(lambda: "it is dismissed" in run.told.read_text(), run, "the refusal")
    late = [network.start_worker(name) for name in ("a", "c")]
    code, told = done(run)
    assert code == 0, told
    address = network.address("b")
    assert f"the Dask worker tcp://{address}:" in told and "has gz-ros2-course 0.0.1, but here it is" in told
    assert told.count("it is dismissed") == 1
    assert other.wait(DEADLINE) is not None, "who is dismissed ends"
    assert all(worker.poll() is None for worker in late)
    assert (out / "gradebook.csv").read_bytes() == alone


def test_who_differs_from_the_beginning_is_refused_by_name(network, submissions, tmp_path):
    scheduler = network.start_scheduler()
    network.start_other_worker("a")
    until(lambda: "Register worker" in scheduler.told.read_text(), scheduler, "the worker")
    code, told = done(network.grade_all(submissions, tmp_path / "out"))
    told = " ".join(told.split())
    assert code == 2 and f"the Dask worker tcp://{network.address('a')}:" in told and "install the same" in told
    assert not (tmp_path / "out/gradebook.csv").exists()


def test_the_scheduler_starts_again(network, submissions, alone, tmp_path):
    scheduler, out = network.start_scheduler(), tmp_path / "out"
    workers = [network.start_worker(name) for name in ("a", "b")]
    run = network.grade_all(submissions, out)
    until(lambda: lines(out) >= 3, run, "the third result")
    scheduler.kill()
    scheduler.wait()
    for worker in workers:
        worker.wait(DEADLINE)  # workers end without their scheduler
    network.start_scheduler()
    for name in ("a", "b"):
        network.start_worker(name)
    code, told = done(run)
    if code == 3:  # it gave up before the new one was there
        assert "the same command goes on" in " ".join(told.split())
        code, told = done(network.grade_all(submissions, out))
    assert code == 0, told
    assert (out / "gradebook.csv").read_bytes() == alone


def test_a_worker_without_the_sandbox_grades_nobody(network, submissions, alone, tmp_path):
    scheduler, out = network.start_scheduler(), tmp_path / "out"
    bare = network.start_other_worker("a", NO_SANDBOX)
    until(lambda: "Register worker" in scheduler.told.read_text(), scheduler, "the worker")
    code, told = done(network.grade_all(submissions, out))
    told = " ".join(told.split())
    assert code == 2 and f"the Dask worker tcp://{network.address('a')}:" in told, told
    assert "has no such sandbox" in told and "level B or better is demanded" in told
    bare.kill()
    network.start_worker("b")
    run = network.grade_all(submissions, out)
    until(lambda: lines(out) >= 2, run, "the second result")
    network.start_other_worker("c", NO_SANDBOX)  # joins late, and would fail faster than the other one grades
    code, told = done(run)
    assert code == 0 and (out / "gradebook.csv").read_bytes() == alone, told
    assert "not graded" not in told
