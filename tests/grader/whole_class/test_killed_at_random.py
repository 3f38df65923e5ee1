"""A class killed again and again at random moments, and gone on with, ends in the same bytes as one left alone.

The moments are fractions of the time that the undisturbed run took, from seeded numbers, early ones and late ones: they
fall into start-up, into gradings, between them, and into the writing of results.
"""

import contextlib
import io
import json
import random
import signal
import subprocess
import sys
import time
import zipfile

import psutil
import pytest

pytestmark = [pytest.mark.proof, pytest.mark.timeout(2400)]

FILE = "teleop_node.py"
COMMAND = [sys.executable, "-c", "from gz_course.grader.course import main; main()", "grade-all", "03_teleop"]
KILLS = 5  # of each class
LATEST = 0.5  # of the undisturbed run's time, from one start to the kill
DEADLINE = 240.0  # [s] for a run of a class
HOST = ("run_wall_seconds", "wall_seconds", "real_time_factor")  # of a report: what differs from run to run
DAEMON = """
import os
if os.fork() == 0:
    os.setsid()
    os.execv("/bin/sleep", ["sleep", "600"])
"""


@pytest.fixture(scope="module")
def submissions(tmp_path_factory, solved, root):
    """Twelve: what earns everything, something and nothing, what ends badly, and what cannot be read."""
    folder = tmp_path_factory.mktemp("class")
    variants = sorted((root / "solutions/03_teleop").glob(f"*/*/{FILE}"))[:4]
    assert len(variants) == 4
    texts = {f"{path.parent.name}/{FILE}": path.read_bytes() for path in variants}
    texts |= {f"Jane Doe_{number}_assignsubmission_file_/{FILE}": solved for number in (1, 2)}
    texts |= {"=1+1.py": solved, f"daemon/{FILE}": DAEMON.encode() + solved, f"dies/{FILE}": b"import os\nos.abort()\n"}
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as packed:
        packed.writestr(f"../{FILE}", solved)
    texts |= {f"eve/{FILE}": b"x = (", "bob.zip": archive.getvalue(), "sue/notes.txt": b""}
    for name, data in texts.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(data)
    assert len(texts) == 12
    return folder


@pytest.fixture(scope="module")
def begin(short_course, submissions, course_environment):
    """Start the class in a folder, in a process group of its own."""
    started = []

    def start(folder):
        with (folder / "told").open("ab") as told:
            process = subprocess.Popen(
                [*COMMAND, str(submissions), "--out", str(folder / "out"), "--jobs", "2"],
                cwd=folder,
                env=course_environment(folder, COURSE_ROOT=str(short_course)),
                stdin=subprocess.DEVNULL,
                stdout=told,
                stderr=told,
                start_new_session=True,
            )
        started.append(process)
        return process

    yield start
    for process in started:
        if process.poll() is None:
            process.kill()
        process.wait()


def kill_it(process):
    """As somebody does who knows the number of the process; its gradings have to notice by themselves."""
    process.kill()
    process.wait()


def kill_all_of_it(process):
    """As a machine does that is short of memory, or goes down: with everything it has started, at once."""
    process.send_signal(signal.SIGSTOP)  # so that it starts nothing meanwhile
    parent = psutil.Process(process.pid)
    while below := [each for each in parent.children(recursive=True) if each.status() != psutil.STATUS_ZOMBIE]:
        for each in below:
            with contextlib.suppress(psutil.NoSuchProcess):
                each.kill()
        psutil.wait_procs(below, timeout=0.1)  # zombies stay: their parent is stopped
    kill_it(process)


def came_out(folder):
    """All that a class leaves, host facts aside; the journal without its order, which is that of the gradings' ends."""
    files = {str(path.relative_to(folder)): path for path in (folder / "out").rglob("*") if path.is_file()}
    reports = {}
    for name, path in files.items():
        if path.name == "report.json":
            report = json.loads(path.read_text())
            reports[name] = json.dumps({key: value for key, value in report.items() if key not in HOST})
    lines = (folder / "out/journal.jsonl").read_text().splitlines()
    return sorted(files), (folder / "out/gradebook.csv").read_bytes(), reports, sorted(lines)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory, begin):
    """What comes out of a run that nobody kills, and how long it takes [s]."""
    folder = tmp_path_factory.mktemp("undisturbed")
    began = time.monotonic()
    assert begin(folder).wait(DEADLINE) == 0, (folder / "told").read_text()
    return came_out(folder), time.monotonic() - began


@pytest.mark.parametrize("kill", [kill_it, kill_all_of_it])
def test_the_same_bytes_come_out(kill, begin, undisturbed, tmp_path, running_in):
    expected, seconds = undisturbed
    chance = random.Random(kill.__name__)
    kills, done = 0, []
    for number in chance.sample(range(KILLS), KILLS):
        moment = LATEST * (number + chance.random()) / KILLS * seconds
        process = begin(tmp_path)
        try:
            assert process.wait(moment) == 0, (tmp_path / "told").read_text()
            break
        except subprocess.TimeoutExpired:
            kill(process)
            kills += 1
        journal = tmp_path / "out/journal.jsonl"
        done.append(journal.read_bytes().count(b"\n") if journal.exists() else 0)
        book = tmp_path / "out/gradebook.csv"
        assert not book.exists() or len(book.read_bytes().splitlines()) == 13, "a line for each, also while it goes on"
    assert kills >= KILLS / 2 and done[0] < 12 and done == sorted(done), "nothing that was done is lost"
    assert begin(tmp_path).wait(DEADLINE) == 0, (tmp_path / "told").read_text()
    print(f"\n{seconds:.1f} s undisturbed; killed {kills} times, after {done} of 12")
    for got, wanted in zip(came_out(tmp_path), expected, strict=True):
        assert got == wanted
    assert psutil.wait_procs(running_in(tmp_path / "tmp"), timeout=120)[1] == []
    assert list((tmp_path / "tmp").iterdir()) == []
