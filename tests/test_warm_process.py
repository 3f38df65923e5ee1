"""A process from a zygote is what a new one would be, or it is a new one."""

import json
import os
import resource
import signal
import subprocess
import sys

import psutil
import pytest

from gz_course.grader.run.domain import Domain
from gz_course.tests.warm_process import PROGRAMS, WarmPopen, run

DEADLINE = 120.0
PYTHON = sys.executable
# What a program can see of how it was started.
STATE = """
import ctypes, json, os, random, signal, sys, threading
from pathlib import Path
libc = ctypes.CDLL(None)
libc.getenv.restype = ctypes.c_char_p
status = dict(line.split(":", 1) for line in Path("/proc/self/status").read_text().splitlines())
streams = (sys.stdin, sys.stdout, sys.stderr)
main = sys.modules["__main__"]
state = {
    "sys": [sys.argv, sys.orig_argv, sys.executable, sys.path, sys.prefix],
    "main": [main.__name__, main.__dict__.get("__file__"), type(main.__loader__).__name__],
    "spec": getattr(main.__spec__, "name", None),
    "names": sorted(name for name in vars(main) if name.startswith("__")),
    "main is ours": main.__dict__ is globals(),
    "environment": [dict(os.environ), libc.getenv(b"GIVEN").decode()],
    "proc": [Path(f"/proc/self/{name}").read_bytes().decode() for name in ("cmdline", "comm")],
    "proc environment": sorted(set(Path("/proc/self/environ").read_bytes().decode().split(chr(0)))),
    "descriptors": [each for each in os.listdir("/proc/self/fd") if Path(f"/proc/self/fd/{each}").exists()],
    "streams": [(s.name, s.mode, s.encoding, s.errors, s.line_buffering, s.write_through, s.newlines) for s in streams],
    "raw streams": [type(s.buffer).__name__ for s in streams],
    "same streams": [s is t for s, t in zip(streams, (sys.__stdin__, sys.__stdout__, sys.__stderr__))],
    "kernel": [status[name] for name in ("Umask", "SigIgn", "SigBlk", "PPid", "Threads")],
    "caught": int(status["SigCgt"], 16) & 0x7FFFFFFF,  # without those of the C library's threads
    "signals": [str(signal.getsignal(number) or signal.SIG_DFL) for number in sorted(signal.valid_signals())],
    "groups": [os.getsid(0) == os.getpid(), os.getpgrp() == os.getpid(), os.getppid()],
    "threads": [threading.active_count(), threading.main_thread().native_id == os.getpid()],
    "folder": os.getcwd(),
    "input": sys.stdin.read(),
}
print(json.dumps(state))
"""
AT_THE_END = """
import atexit, os, signal, sys, threading
class Last:
    def __del__(self):
        os.write(1, b"deleted ")
kept = Last()
atexit.register(lambda: print("at exit", end=" "))
thread = threading.Thread(target=lambda: (threading.main_thread().join(), print("thread", end=" ")))
print("begins", end=" ")
thread.start()
how = sys.argv[1]
if how == "error":
    1 / 0
elif how == "message":
    sys.exit("a message")
elif how == "interrupt":
    os.kill(os.getpid(), signal.SIGINT)
elif how == "kill":
    os.kill(os.getpid(), signal.SIGKILL)
elif how == "abort":
    os.abort()
elif how:
    sys.exit(int(how))
"""
# What the libraries of ROS and of Gazebo read from the environment when they are used.
LIBRARIES = """
import os, shutil, sys
import rclpy
from pathlib import Path
from gz_course.sim.gz.transport.environment import default_partition
from rich.console import Console
rclpy.init()
node = rclpy.create_node("told")
node.get_logger().warning("a line")
rclpy.logging.get_logger("told").debug("a detail")
Console(force_terminal=True).print("[red]red[/red] " + "word " * 12)
shared = "fastrtps_" in Path("/proc/self/maps").read_text()
print(node.context.get_domain_id(), default_partition(), shutil.get_terminal_size().columns, "shared memory:", shared)
print(len(os.listdir(os.environ["ROS_LOG_DIR"])), "log files")
node.destroy_node()
rclpy.shutdown()
"""


def both(command, make=WarmPopen, **options):
    """Run a command in both ways; return exit code, output and errors of both."""
    ended = []
    for popen in (subprocess.Popen, make):
        process = popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)
        ended.append((process.communicate(timeout=DEADLINE), process.returncode))
    assert process.warm
    return ended


@pytest.mark.parametrize(
    ("variables", "options"),
    [({}, {}), ({"PYTHONUNBUFFERED": "1", "PYTHONFAULTHANDLER": "1"}, {"start_new_session": True, "umask": 0o27}),
     ({}, {"process_group": 0})],
    ids=["as it is", "unbuffered", "group"],
)  # fmt: skip
@pytest.mark.parametrize("words", [["-c", STATE], ["-m", "state"], ["-P", "-m", "state"], ["state.py"]])
def test_it_sees_what_a_new_process_sees(tmp_path, words, variables, options):
    (tmp_path / "state.py").write_text(STATE)
    before = signal.signal(signal.SIGUSR1, signal.SIG_IGN)
    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGUSR2})
    environment = os.environ | {"GIVEN": "ü"} | variables
    try:
        new, warm = both([PYTHON, *words, "a", "ü"], cwd=tmp_path, env=environment, stdin=subprocess.DEVNULL, **options)
    finally:
        signal.signal(signal.SIGUSR1, before)
        signal.pthread_sigmask(signal.SIG_SETMASK, blocked)
    if "-P" in words:  # it finds no module in its folder
        assert new == warm
        assert "No module named state" in warm[0][1]
        return
    (new, _), code = new
    (warm, errors), other_code = warm
    assert (code, other_code, errors) == (0, 0, "")
    assert json.loads(warm) == json.loads(new)


@pytest.mark.parametrize("how", ["", "0", "7", "error", "message", "interrupt", "kill", "abort"])
def test_it_ends_as_a_new_process_ends(tmp_path, how):
    script = tmp_path / "end.py"
    script.write_text(AT_THE_END)
    new, warm = both([PYTHON, str(script), how])
    assert warm == new


def test_variables_of_libraries_count(tmp_path):
    variables = {
        "RCUTILS_CONSOLE_OUTPUT_FORMAT": "<{severity}> {message}",
        "RCUTILS_LOGGING_USE_STDOUT": "1",
        "RCUTILS_COLORIZED_OUTPUT": "1",
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
        "GZ_PARTITION": "mine",
        "COLUMNS": "31",
        "NO_COLOR": "1",
        "TERM": "xterm-256color",
    }
    with Domain() as domain:
        changed = os.environ | variables | {"ROS_DOMAIN_ID": str(domain.id)}
        for number, environment in enumerate((changed, changed | {"GZ_PARTITION": "yours", "COLUMNS": "200"})):
            logs = tmp_path / str(number)
            # A new process makes the folder; in it each makes a file.
            new, warm = both([PYTHON, "-c", LIBRARIES], env=environment | {"ROS_LOG_DIR": str(logs)})
            assert warm[0][0].replace("2 log files", "1 log files") == new[0][0]
            assert (warm[0][1], warm[1], new[1]) == (new[0][1], 0, 0)
            assert f"{domain.id} {environment['GZ_PARTITION']} {environment['COLUMNS']}" in warm[0][0]
            assert "<WARN> a line" in warm[0][0]


def test_it_is_a_child_like_any_other():
    code = "import os, sys, time; print('up', flush=True); sys.stdin.read(); [None for _ in range(2_000_000)]"
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    with WarmPopen(
        [PYTHON, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True
    ) as child:
        assert child.warm
        assert child.stdout.readline() == b"up\n"
        assert child.poll() is None
        assert os.getpgid(child.pid) == child.pid
        assert psutil.Process(child.pid).ppid() == os.getpid()
        with pytest.raises(subprocess.TimeoutExpired):
            child.wait(0.01)
    assert child.returncode == 0
    assert resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime > before
    with WarmPopen([PYTHON, "-c", "print('up', flush=True); input()"], stdin=-1, stdout=-1, process_group=0) as child:
        child.stdout.readline()
        os.killpg(child.pid, signal.SIGTERM)
    assert child.returncode == -signal.SIGTERM


def test_programs_of_the_course():
    bridge = [PYTHON, "-P", "-m", "gz_course.sim.bridge.ros_gz_bridge.parameter_bridge", "--help"]
    for words in (["ros2", "pkg", "prefix", "rclpy"], ["gz", "topic", "--help"], ["course", "list", "--help"], bridge):
        new, warm = both([str(PROGRAMS / words[0]), *words[1:]])
        assert warm == new
        assert (new[1], new[0][1]) == (0, "")


def test_what_a_zygote_cannot_stand_for_is_a_new_process(tmp_path):
    def is_warm(*command, **options):
        with WarmPopen(command or [PYTHON, "-c", ""], **options) as process:
            pass
        assert process.returncode == 0
        return process.warm

    assert is_warm()
    assert not is_warm("true")
    assert not is_warm(PYTHON, "-I", "-c", "")
    assert not is_warm(PYTHON, "-Xdev", "-c", "")
    assert not is_warm("sh", "-c", "true")
    for name in ("PYTHONPATH", "PYTHONWARNINGS", "LANG", "LC_ALL", "LD_LIBRARY_PATH", "MUJOCO_GL", "TZ"):
        assert not is_warm(env={**os.environ, name: "C" if name[:2] in ("LA", "LC") else "default"}), name
    assert not is_warm(preexec_fn=os.getpid)
    assert not is_warm(close_fds=False)
    assert not is_warm(restore_signals=False)
    (tmp_path / "numpy.py").touch()
    assert not is_warm(cwd=tmp_path)
    assert is_warm(PYTHON, "-P", "-c", "", cwd=tmp_path)
    assert not is_warm(pass_fds=[2])
    with pytest.raises(FileNotFoundError, match="absent"):
        WarmPopen([PYTHON, "-c", ""], cwd=tmp_path / "absent")
    soft, hard = resource.getrlimit(resource.RLIMIT_CORE)
    resource.setrlimit(resource.RLIMIT_CORE, (0, hard))
    try:
        assert is_warm() == (soft == 0)
    finally:
        resource.setrlimit(resource.RLIMIT_CORE, (soft, hard))


def test_run():
    done = run([PYTHON, "-c", "print(input())"], input="word", capture_output=True, text=True, check=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "word\n", "")
    with pytest.raises(subprocess.CalledProcessError):
        run([PYTHON, "-c", "exit(3)"], check=True)
    with pytest.raises(subprocess.TimeoutExpired):
        run([PYTHON, "-c", "import signal; signal.pause()"], timeout=0.1)
