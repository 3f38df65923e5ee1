"""What the hostile tests share: workers that grade at one level, as root or as an ordinary user."""

import contextlib
import dataclasses
import json
import os
import selectors
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import psutil
import pytest

from gz_course.grader.run.sandbox.levels.a import program as bubblewrap

from .attack_table import place_of

ROOT = Path(__file__).parents[2]
SOLUTION = ROOT / "solutions/03_teleop/teleop_node.py"
# From here on: users nobody is, ten for each worker of the test run.
ORDINARY = 61_900 + 10 * int(os.environ.get("PYTEST_XDIST_WORKER", "gw0")[2:])
LONGEST = 600.0  # [s] for one answer


@dataclasses.dataclass
class Worker:
    """A process that grades at `level`; as an ordinary user if `user` says so."""

    level: str
    user: int | None
    folder: Path

    def __post_init__(self):
        self.tmp = self.folder / "tmp"
        self.tmp.mkdir(mode=0o777)
        for path in (self.folder, self.tmp):
            path.chmod(0o777)
        command = [sys.executable, str(Path(__file__).with_name("worker.py")), self.level]
        if self.user is None and self.level in "CD":
            command = [*self._container(), *command]
        if self.user is not None:
            become = Path(__file__).with_name("ordinary_user.py")
            command = [sys.executable, "-I", "-S", str(become), str(self.user), str(self.tmp), *command]
        kept = {k: v for k, v in os.environ.items() if not k.startswith(("ROS_", "GZ_", "COURSE_"))}
        self.errors = (self.folder / "errors").open("wb")
        self.terminal, slave = os.openpty()  # as where somebody grades by hand: it is the worker's, and is never read
        name = os.ttyname(slave)
        self.process = subprocess.Popen(
            command,
            preexec_fn=lambda: os.close(os.open(name, os.O_RDWR)),
            bufsize=0,  # nothing read ahead: the selector below sees all there is
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self.errors,
            cwd=self.folder,
            env=kept | {"TMPDIR": str(self.tmp), "COURSE_ROOT": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1"},
            start_new_session=True,
        )
        os.close(slave)
        self.numbers = iter(range(10_000))

    def _container(self):
        """Return the start of a command in a container like one of Docker: root, but without capabilities.

        Below level B an attack by root would hit this machine.
        """
        words = [str(bubblewrap()), "--die-with-parent", "--unshare-pid", "--unshare-ipc", "--unshare-uts"]
        words += ["--cap-drop", "ALL", "--ro-bind", "/", "/", "--dev", "/dev", "--proc", "/proc", "--tmpfs", "/tmp"]
        return [*words, "--bind", str(self.folder), str(self.folder), "--chdir", str(self.folder), "--"]

    @property
    def lives(self):
        """Whether it can grade; an attack at a weak level may have ended it."""
        return self.process.poll() is None

    def grade(self, files, exercise="03_teleop"):
        """Grade a submission of some files (name -> text); what the worker tells about it."""
        submission = self.folder / f"submission-{next(self.numbers)}"
        submission.mkdir()
        for name, text in files.items():
            (submission / name).parent.mkdir(parents=True, exist_ok=True)
            (submission / name).write_text(text)
        out = self.tmp / "out"
        self.process.stdin.write(json.dumps([str(submission), str(out), exercise]).encode() + b"\n")
        self.process.stdin.flush()
        told = json.loads(self._line())
        shutil.rmtree(out)
        return told

    def _line(self):
        end = time.monotonic() + LONGEST
        with selectors.DefaultSelector() as selector:
            selector.register(self.process.stdout, selectors.EVENT_READ)
            while time.monotonic() < end and not self._frozen():
                if selector.select(1.0):
                    line = self.process.stdout.readline()
                    if line.strip():
                        return line
                    if not line:
                        break
        raise WorkerGoneError(f"the worker is gone: {(self.folder / 'errors').read_text()[-2000:]}")

    def _frozen(self):
        """Whether somebody has stopped the grader, as an attack can at level D; it is ended then."""
        stopped = (psutil.STATUS_STOPPED, psutil.STATUS_TRACING_STOP)
        with contextlib.suppress(psutil.Error):
            tree = [psutil.Process(self.process.pid), *psutil.Process(self.process.pid).children(recursive=True)]
            graders = [each for each in tree if str(Path(__file__).with_name("worker.py")) in each.cmdline()]
            if any(each.status() in stopped for each in graders):
                os.killpg(self.process.pid, signal.SIGKILL)
                return True
        return False

    def left(self):
        """What is left of its boxes: processes and shared memory of their users, temporary files."""
        users = {self.user} if self.user is not None else {*range(61_001, 61_102), *range(61_201, 61_302)}
        found = [p for p in psutil.process_iter() if is_of(p, users) and p.pid != self.process.pid]
        mine = {p.pid for p in psutil.Process(self.process.pid).children(recursive=True)}
        processes = [p for p in found if self.user is not None or p.pid in mine]
        # Of the grader itself: a file of a tracing library, one a user.
        memory = [p for p in Path("/dev/shm").iterdir() if owner(p) in users and "lttng" not in p.name]
        return [*processes, *memory, *(p for p in self.tmp.iterdir() if p.name not in (".cache", ".config", "out"))]

    def counted(self):
        """How many processes, files and pieces of shared memory are left, for the table."""
        left = self.left()
        memory = sum(getattr(each, "parent", None) == Path("/dev/shm") for each in left)
        processes = sum(isinstance(each, psutil.Process) for each in left)
        return f" {processes}/{len(left) - processes - memory}/{memory}"

    def close(self):
        if self.errors.closed:
            return
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
        try:
            self.process.wait(120)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()
        for each in psutil.process_iter() if self.user is not None else ():
            if is_of(each, {self.user}):
                each.kill()
        self.process.stdout.close()
        self.errors.close()
        os.close(self.terminal)


class WorkerGoneError(AssertionError):
    """The process that grades has ended, or does not answer."""


def owner(path):
    try:
        return path.lstat().st_uid
    except OSError:
        return None


def is_of(process, users):
    try:
        return process.uids().real in users and process.status() != psutil.STATUS_ZOMBIE
    except psutil.Error:
        return False


@pytest.fixture(scope="session")
def solution():
    return SOLUTION.read_text()


@pytest.fixture(scope="session")
def workers():
    """`workers(level, user)`: the worker of that kind, started when first asked for."""
    running = {}

    def call(level, user):
        if (level, user) in running and not running[level, user].lives:
            gone = running.pop((level, user))
            gone.close()
            shutil.rmtree(gone.folder, ignore_errors=True)
        if (level, user) not in running:
            folder = Path(tempfile.mkdtemp(prefix="hostile-"))  # pytest's own folders are closed to other users
            running[level, user] = Worker(level, user, folder)
        return running[level, user]

    yield call
    for worker in running.values():
        worker.close()
        shutil.rmtree(worker.folder)


@pytest.fixture(autouse=True)
def _in_the_table(request):
    """Give each test its place in the table of attacks, unless its file says `NO_ATTACKS`."""
    if not getattr(request.module, "NO_ATTACKS", False):
        request.node.user_properties.append(("attack", place_of(request.node)))
