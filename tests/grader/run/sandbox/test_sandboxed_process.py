"""A process in its box, at every level that works here: its end, its signals, its files, and that nothing stays."""

import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.run.sandbox import LEVELS, Sandbox
from gz_course.grader.run.sandbox import sandbox as module
from gz_course.grader.run.sandbox.probe import try_level
from gz_course.grader.run.sandbox.sandboxed_process import SandboxedProcess
from gz_course.tests.descriptors import left_open, own_descriptors

DEADLINE = 120.0
PYTHON = [sys.executable, "-I", "-S"]


@pytest.fixture(scope="module")
def lacks():
    return {level: try_level(level) if level != "D" else "" for level in LEVELS}


@pytest.fixture(params=LEVELS)
def sandbox(request, lacks, tmp_path, monkeypatch):
    if lacks[request.param]:
        pytest.skip(f"no level {request.param} here: {lacks[request.param]}")
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    network, before = own_network(), own_descriptors()
    box = Sandbox(97, request.param)
    yield box
    box.close()
    assert list(tmp_path.iterdir()) == []
    assert own_network() == network
    assert left_open(before) == {}


def own_network():
    return Path("/proc/thread-self/ns/net").readlink()


def run(sandbox, code, *arguments):
    boxed = sandbox.start([*PYTHON, "-c", code, *arguments], {})
    with boxed.stdout, boxed.stderr:
        said = boxed.stdout.read().decode()
        return boxed.wait(DEADLINE), said, boxed.stderr.read().decode()


@pytest.mark.parametrize(
    ("code", "exit_code"),
    [
        ("pass", 0),
        ("raise SystemExit(3)", 3),
        ("raise SystemExit(139)", 139),  # what a shell makes of a segmentation fault
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", -signal.SIGKILL),
        ("import os, signal; os.kill(os.getpid(), signal.SIGSEGV)", -signal.SIGSEGV),
    ],
)
def test_the_end_is_told_as_it_was(sandbox, code, exit_code):
    assert run(sandbox, code)[0] == exit_code


def test_a_signal_reaches_it_and_it_may_answer(sandbox):
    code = (
        "import signal\ntry: print('ready', flush=True); signal.pause()\nexcept KeyboardInterrupt: raise SystemExit(7)"
    )
    boxed = sandbox.start([*PYTHON, "-c", code], {})
    with boxed.stdout, boxed.stderr:
        assert boxed.stdout.readline() == b"ready\n"
        assert boxed.poll() is None
        with pytest.raises(subprocess.TimeoutExpired):
            boxed.wait(0.01)
        boxed.signal(signal.SIGINT)
        assert boxed.wait(DEADLINE) == 7
        assert (boxed.running, boxed.returncode) == (False, 7)


def test_what_is_killed_was_killed(sandbox):
    boxed = sandbox.start([*PYTHON, "-c", "import signal; print(1, flush=True); signal.pause()"], {})
    with boxed.stdout, boxed.stderr:
        boxed.stdout.readline()
        boxed.kill()
        assert boxed.wait(DEADLINE) == -signal.SIGKILL


def test_staged_files_can_be_read_but_not_changed(sandbox):
    folder = sandbox.put_files({"node.py": b"pass\n", "launch/all.launch.py": b"more\n"})
    if sandbox.level != "D":
        code = (
            "import sys\nfor n in ('node.py', 'launch/all.launch.py', 'new.py'):\n"
            "    try: open(sys.argv[1] + '/' + n, 'w')\n    except OSError: print('refused')\n"
        )
        assert run(sandbox, code, str(folder))[1] == "refused\n" * 3
    code = (
        "import sys; print(open(sys.argv[1] + '/node.py').read() + open(sys.argv[1] + '/launch/all.launch.py').read())"
    )
    assert run(sandbox, code, str(folder))[1].split() == ["pass", "more"]


def test_it_starts_in_its_home_and_may_write_there(sandbox):
    code = "import os; open('x', 'w').write('y'); print(os.getcwd(), os.environ['HOME'], os.environ['MORE'])"
    boxed = sandbox.start([*PYTHON, "-c", code], {"MORE": "this"})
    with boxed.stdout, boxed.stderr:
        assert boxed.stdout.read().decode().split() == [str(sandbox.home), str(sandbox.home), "this"]
        assert boxed.wait(DEADLINE) == 0


def test_inherited_descriptors_keep_their_numbers_and_no_other_is_open(sandbox):
    reading, writing = os.pipe()
    secret = os.open("/dev/null", os.O_RDONLY)
    os.set_inheritable(secret, True)
    code = "import os; print(sorted(n for n in range(3, 256) if os.path.exists(f'/proc/self/fd/{n}'))[:9], flush=True)"
    boxed = sandbox.start([*PYTHON, "-c", code], {}, (writing,))
    for descriptor in (reading, writing, secret):
        os.close(descriptor)
    with boxed.stdout, boxed.stderr:
        assert boxed.stdout.read().decode().strip() == f"[{writing}]"
        assert boxed.wait(DEADLINE) == 0


def test_the_machine_in_a_box_has_the_same_name_everywhere(sandbox):
    if sandbox.level in "CD":
        pytest.skip("without namespaces it is the machine's")
    said = run(sandbox, "import os; print(os.uname().nodename, *os.listdir('/tmp'), os.listdir('/dev/shm'))")[1]
    # Python itself may be installed below /tmp.
    python = [path.name for path in Path(sys.prefix).parents if path.parent == Path("/tmp")]
    assert said.split() == ["course", *python, "[]"]


def test_a_program_that_is_not_there_is_told(sandbox):
    if sandbox.level == "D":
        with pytest.raises(FileNotFoundError):
            sandbox.start(["/no/such/program"], {})
        return
    boxed = sandbox.start(["/no/such/program"], {})
    with boxed.stdout, boxed.stderr, pytest.raises(InfrastructureError, match=f"level {sandbox.level}.*No such file"):
        boxed.wait(DEADLINE)


def test_a_box_that_cannot_be_built_is_the_machines_fault(sandbox, monkeypatch):
    if sandbox.level in "CD":
        pytest.skip("there is nothing to build")
    real = module.view
    gone = [p for p in real(sandbox.folder, sandbox.folder, sandbox.folder / "etc") if p.path == "/usr"]
    monkeypatch.setattr(
        module, "view", lambda *folders: [*real(*folders), type(gone[0])("bind", "/x", "/no/such/place")]
    )
    boxed = sandbox.start([*PYTHON, "-c", "pass"], {})
    with boxed.stdout, boxed.stderr, pytest.raises(InfrastructureError, match="/no/such/place"):
        boxed.wait(DEADLINE)


def test_two_processes_in_a_box_talk_over_tcp_on_loopback(sandbox):
    if sandbox.level == "C":
        pytest.skip("Landlock cannot tell loopback from elsewhere")
    code = (
        "import socket\nl = socket.create_server(('127.0.0.1', 0))\nc = socket.create_connection(l.getsockname())\n"
        "c.send(b'hi'); print(l.accept()[0].recv(9))"
    )
    assert run(sandbox, code)[1] == "b'hi'\n"


@pytest.fixture
def outermost():
    """A process of a box that has ended, after it told some messages and left a signal unread."""
    made = []

    def call(code, *messages, says=""):
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        ours.send(bytes([signal.SIGTERM]))
        for message in messages:
            theirs.send(message)
        theirs.close()
        script = "import sys; sys.stderr.write(sys.argv[1]); sys.exit(int(sys.argv[2]))"
        process = subprocess.Popen([*PYTHON, "-c", script, says, str(code)], stderr=subprocess.PIPE)
        made.append(SandboxedProcess(process, "A", ours, True))
        return made[-1]

    yield call
    for each in made:
        each.close()
        each.stderr.close()


def test_the_end_is_told_although_a_signal_came_too_late(outermost):
    assert outermost(0, b"begun 2", b"exit 7").wait(DEADLINE) == 7


def test_what_a_submission_prints_is_no_reason_of_the_machine(outermost):
    ended = outermost(1, b"begun 2", says="Traceback (most recent call last):\nKeyboardInterrupt\n")
    assert ended.wait(DEADLINE) == -signal.SIGKILL


def test_what_a_box_prints_before_it_begins_is(outermost):
    with pytest.raises(InfrastructureError, match="bwrap: no"):
        outermost(1, says="bwrap: no namespaces").wait(DEADLINE)
