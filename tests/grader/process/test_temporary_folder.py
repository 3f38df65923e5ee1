"""Folders of the dead are removed with whoever still lives in them; those of the living are never touched."""

import os
import signal
import subprocess
import sys
import threading
import time
from functools import partial
from pathlib import Path

import psutil
import pytest

from gz_course.grader.process import temporary_folder
from gz_course.grader.process.temporary_folder import OWNER, TemporaryFolder, abandoned, remove, sweep
from gz_course.tests.descriptors import left_open, own_descriptors

DEADLINE = 120.0
MAKES_ONE = """
import sys
from gz_course.grader.process.temporary_folder import TemporaryFolder
folder = TemporaryFolder("course-")
print(folder.path, flush=True)
sys.stdin.read()
"""
# As a daemon of a submission: in a session of its own, and nobody's child.
DAEMON = """
import os, time
if os.fork():
    os._exit(0)
os.setsid()
print(os.getpid(), flush=True)
os.dup2(os.open(os.devnull, os.O_RDWR), 1)
time.sleep(600)
"""


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    return tmp_path


@pytest.fixture
def owner(here):
    """`owner()` starts a program that has a folder: the program and the folder's path."""
    started = []

    def start():
        process = subprocess.Popen(
            [sys.executable, "-c", MAKES_ONE],
            env=os.environ | {"TMPDIR": str(here)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        started.append(process)
        return process, Path(process.stdout.readline().strip())

    yield start
    for process in started:
        process.kill()
        process.communicate()


def ended(process):
    return not process.is_running() or process.status() == psutil.STATUS_ZOMBIE


def killed(process):
    process.kill()
    process.wait(DEADLINE)


def test_the_folder_of_one_who_was_killed_is_removed_and_that_of_the_living_is_not(owner, here):
    dead, folder = owner()
    _, kept = owner()
    (folder / "home").mkdir()
    (folder / "home/x").write_text("x")
    assert abandoned() == []
    sweep()
    assert folder.exists() and kept.exists()
    killed(dead)
    assert abandoned() == [folder]
    sweep()
    assert list(here.iterdir()) == [kept]


def test_it_is_removed_in_the_end_and_gives_its_descriptor_back(here):
    before = own_descriptors()
    with TemporaryFolder("course-x-") as folder:
        (folder / "file").write_text("x")
        assert folder.stat().st_mode & 0o777 == 0o700
        sweep()
        assert (folder / "file").exists()
    assert list(here.iterdir()) == []
    assert left_open(before) == {}


def test_between_any_two_lines_of_its_making_a_sweep_leaves_it_alone(here):
    swept = []

    def look(frame, event, _):
        if frame.f_code.co_filename != temporary_folder.__file__:
            return None
        if event == "line":
            before = sorted(here.rglob("*"))
            sweep()
            swept.append(frame.f_lineno)
            assert sorted(here.rglob("*")) == before, f"swept before line {frame.f_lineno}"
        return look

    sys.settrace(look)
    try:
        folder = TemporaryFolder("course-")
    finally:
        sys.settrace(None)
    assert len(swept) >= 6 and (folder.path / OWNER).exists()
    folder.close()


def test_of_two_sweeps_at_once_both_end_well(owner, here):
    for _ in range(4):
        process, folder = owner()
        for number in range(50):
            (folder / str(number)).mkdir()
        killed(process)
    sweeps = [threading.Thread(target=sweep) for _ in range(4)]
    for each in sweeps:
        each.start()
    for each in sweeps:
        each.join()
    assert list(here.iterdir()) == []


def test_a_sweep_that_was_killed_is_gone_on_with(owner, here, monkeypatch):
    process, folder = owner()
    (folder / "home").mkdir()
    killed(process)
    with monkeypatch.context() as patch:
        patch.setattr(Path, "rmdir", lambda self: (_ for _ in ()).throw(KeyboardInterrupt))
        with pytest.raises(KeyboardInterrupt):
            sweep()
    assert abandoned() == [folder]
    sweep()
    assert list(here.iterdir()) == []


@pytest.mark.parametrize("name", ["course-abcd1234", "playground-abcd1234", "course-notes", "thesis"])
def test_what_never_had_an_owner_is_not_ours(here, name):
    (here / name).mkdir()
    (here / name / "notes.txt").write_text("x")
    sweep()
    assert (here / name / "notes.txt").exists()


def test_links_in_the_place_of_folders_or_files_are_not_followed(here, tmp_path_factory):
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    (elsewhere / OWNER).write_text("")
    (elsewhere / "precious").write_text("x")
    (here / "course-abcd1234").symlink_to(elsewhere)
    (here / "course-efgh5678").mkdir()
    (here / "course-efgh5678" / OWNER).symlink_to(elsewhere / OWNER)
    sweep()
    (here / "course-ijkl9012").mkdir()
    (here / "course-ijkl9012" / OWNER).write_text("")
    (here / "course-ijkl9012/link").symlink_to(elsewhere)
    sweep()
    assert sorted(path.name for path in elsewhere.iterdir()) == [OWNER, "precious"]
    assert sorted(path.name for path in here.iterdir()) == ["course-abcd1234", "course-efgh5678"]


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give files away")
def test_the_folder_of_another_user_is_not_ours(here):
    folder = here / "course-abcd1234"
    folder.mkdir()
    (folder / OWNER).write_text("")
    os.chown(folder, 61_950, 61_950)
    sweep()
    assert abandoned() == [] and (folder / OWNER).exists()


def test_a_file_system_without_locks_keeps_its_folders(here, monkeypatch):
    def refuse(*_):
        raise OSError(37, "No locks available")

    with monkeypatch.context() as patch:
        patch.setattr(temporary_folder.fcntl, "flock", refuse)
        folder = TemporaryFolder("course-")
    assert list(folder.path.iterdir()) == []
    sweep()
    assert folder.path.exists()
    folder.close()
    assert list(here.iterdir()) == []


def test_folders_nested_deeper_than_python_can_call_are_removed(here, request):
    request.addfinalizer(partial(sys.setrecursionlimit, sys.getrecursionlimit()))
    sys.setrecursionlimit(300)
    with TemporaryFolder("course-") as folder:
        where = os.open(folder, os.O_RDONLY)
        for _ in range(400):
            os.mkdir("deeper", dir_fd=where)
            where, before = os.open("deeper", os.O_RDONLY, dir_fd=where), where
            os.close(before)
        os.close(where)
    assert list(here.iterdir()) == []


AS_A_USER = """
import os, sys
from pathlib import Path
from gz_course.grader.run.sandbox.init import kernel
from gz_course.grader.process.temporary_folder import TemporaryFolder
kernel.drop_capabilities(61_950, 61_950)
with TemporaryFolder("course-", sys.argv[1]) as folder:
    for name in ("closed", "closed/within", "closed/within/deeper"):
        (folder / name).mkdir()
        (folder / name / "file").write_text("x")
    for name in ("closed/within/deeper", "closed/within", "closed"):
        (folder / name / "file").chmod(0)
        (folder / name).chmod(0)
    try:
        list((folder / "closed").iterdir())
    except PermissionError:
        print("closed")
"""


@pytest.mark.skipif(os.geteuid() != 0, reason="root becomes an ordinary user here, whom permissions hold back")
def test_what_may_not_be_read_or_written_is_removed(tmp_path_factory):
    import tempfile

    place = Path(tempfile.mkdtemp(dir="/tmp"))  # pytest's own folders are closed to other users
    try:
        place.chmod(0o777)
        done = subprocess.run(
            [sys.executable, "-c", AS_A_USER, str(place)], capture_output=True, text=True, timeout=600
        )
        assert (done.returncode, done.stdout) == (0, "closed\n"), done.stderr
        assert list(place.iterdir()) == []
    finally:
        subprocess.run(["rm", "-rf", str(place)], check=True)


MOUNTS = """
import os, sys
from pathlib import Path
from gz_course.grader.run.sandbox.init import kernel
from gz_course.grader.process.temporary_folder import TemporaryFolder
kernel.unshare(kernel.CLONE_NEWNS)
kernel.mount("", "/", flags=kernel.MS_REC | kernel.MS_PRIVATE)
precious = Path(sys.argv[1])
folder = TemporaryFolder("course-")
(folder.path / "a b").mkdir()
kernel.mount(str(precious), str(folder.path / "a b"), flags=kernel.MS_BIND)
folder.close()
print((folder.path / "a b/file").exists(), (precious / "file").exists(), oct(precious.stat().st_mode & 0o777))
"""


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can mount")
def test_what_is_mounted_in_it_is_not_touched(here, tmp_path_factory, monkeypatch):
    precious = tmp_path_factory.mktemp("precious")
    (precious / "file").write_text("x")
    precious.chmod(0o755)
    base = here / "a name of four"
    base.mkdir()
    command = [sys.executable, "-c", MOUNTS, str(precious)]
    done = subprocess.run(command, env=os.environ | {"TMPDIR": str(base)}, capture_output=True, text=True, timeout=600)
    assert (done.returncode, done.stdout) == (0, "True True 0o755\n"), done.stderr
    (folder,) = base.iterdir()
    monkeypatch.setattr("tempfile.tempdir", str(base))
    sweep()  # the mount was that process's own, and went with it
    assert (precious / "file").exists() and not folder.exists()


@pytest.mark.parametrize("inside", [True, False])
def test_a_daemon_that_lives_in_it_ends_with_it(owner, here, inside):
    process, folder = owner()
    (folder / "home").mkdir()
    home = folder / "home" if inside else here
    environment = {"TMPDIR": str(home), "PATH": os.environ["PATH"], "EDITOR": f"{folder}/home/vi"}
    done = subprocess.run([sys.executable, "-I", "-S", "-c", DAEMON], env=environment, stdout=subprocess.PIPE)
    daemon = psutil.Process(int(done.stdout))
    try:
        sweep()
        assert daemon.is_running(), "its owner lives"
        killed(process)
        sweep()
        assert not folder.exists()
        assert ended(daemon) == inside
    finally:
        if not ended(daemon):
            daemon.kill()


def test_no_program_that_its_owner_starts_keeps_it_alive(owner, here):
    code = MAKES_ONE.replace(
        "sys.stdin.read()",
        "import subprocess\ndaemon = subprocess.Popen(['sleep', '600'], stdin=-3, stdout=-3, close_fds=False)\n"
        "print(daemon.pid, flush=True)\nsys.stdin.read()",
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        env=os.environ | {"TMPDIR": str(here)},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    folder, daemon = Path(process.stdout.readline().strip()), int(process.stdout.readline())
    try:
        process.kill()
        process.communicate(timeout=DEADLINE)
        assert psutil.pid_exists(daemon) and abandoned() == [folder]
    finally:
        os.kill(daemon, signal.SIGKILL)


def test_where_nothing_is_left_it_costs_nothing(owner, here):
    for _ in range(3):
        owner()
    for number in range(200):
        (here / f"somebody's-{number}").mkdir()
    times = []
    for _ in range(21):
        began = time.thread_time()
        sweep()
        times.append(time.thread_time() - began)
    assert min(times) < 0.001


def test_removing_what_is_not_there_is_harmless(here):
    remove(here / "course-gone")
    (here / "file").write_text("x")
    remove(here / "file")
    assert (here / "file").exists()
