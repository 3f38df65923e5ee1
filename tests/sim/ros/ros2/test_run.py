"""`ros2 run`: finding the executable, arguments, exit code and signals."""

import os
import signal
import subprocess
import sys

import psutil
import pytest

from gz_course.tests.sim.command_line import command_of

# Prints the signals it receives, after its own child has printed them.
LISTENER = f"""\
#!{sys.executable}
import os, signal, sys
# Blocked signals wait until they are fetched; a handler's could come just before pause(), which would sleep on.
signals = [signal.SIGINT, signal.SIGTERM]
if signal.SIG_IGN in map(signal.getsignal, signals):
    sys.exit("started with an ignored signal")
signal.pthread_sigmask(signal.SIG_BLOCK, signals)
child = os.fork()
who = "parent" if child else "child"
if not child:
    os.write(1, b"up\\n")
number = signal.sigwait(signals)
if child:
    os.waitpid(child, 0)
os.write(1, f"{{who}} heard {{signal.Signals(number).name}}\\n".encode())
os._exit(number)
"""


def test_arguments_and_exit_code_pass_through(ros2, workspace):
    environment = workspace("driver", '#!/bin/sh\nfor word; do echo "<$word>"; done\nexit 7\n')
    words = ["a b", "--", "--ros-args", "-p", "x:=1", "--prefix", "-h"]
    code, text, errors = ros2("run", "my_robot", "driver", *words, environment=environment)
    assert (code, errors) == (7, "")
    assert text == "".join(f"<{word}>\n" for word in words) + "[ros2run]: Process exited with failure 7\n"


def test_success_is_silent(ros2, workspace):
    environment = workspace("driver", "#!/bin/sh\nexit 0\n")
    assert ros2("run", "my_robot", "driver", environment=environment) == (0, "", "")


def test_a_prefix_starts_the_executable(ros2, workspace):
    environment = workspace("driver", "#!/bin/sh\necho $WHEELS\n")
    arguments = ["run", "--prefix", "env 'WHEELS=two big'", "my_robot", "driver"]
    assert ros2(*arguments, environment=environment)[:2] == (0, "two big\n")


def test_death_by_a_signal_is_told(ros2, workspace):
    environment = workspace("driver", "#!/bin/sh\nkill -SEGV $$\n")
    code, text, _ = ros2("run", "my_robot", "driver", environment=environment)
    assert (code, text) == (256 - signal.SIGSEGV, "[ros2run]: Segmentation fault\n")


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["my_robt", "driver"], "Package 'my_robt' not found; did you mean 'my_robot'?"),
        (["my_robot", "drivr"], "No executable found; did you mean 'driver'?"),
        (["my_robot", "driver"], "Multiple executables found:"),
        (["--prefix", "no-such-program", "my_robot", "text"], "there is no program 'no-such-program'"),
        (["my_robot", "text"], "does not start: its first line must be #! and an interpreter"),
    ],
)
def test_what_cannot_be_started_is_exit_code_1(ros2, workspace, arguments, sentence):
    workspace("text", "no interpreter")
    workspace("nested/driver", "#!/bin/sh\n")
    environment = workspace("driver", "#!/bin/sh\n")
    code, text, errors = ros2("run", *arguments, environment=environment)
    assert (code, text) == (1, "")
    assert sentence in errors
    assert "Traceback" not in errors
    if "Multiple" in sentence:
        install = environment["AMENT_PREFIX_PATH"]
        paths = [f"- {install}/lib/my_robot/driver", f"- {install}/lib/my_robot/nested/driver"]
        assert errors.splitlines()[1:] == paths


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_to_ros2_reaches_the_whole_group_of_the_child(start, workspace, number):
    command = start("run", "my_robot", "listener", environment=workspace("listener", LISTENER))
    command.wait_for("up")
    os.kill(command.process.pid, number)
    code, text, _ = command.wait()
    assert code == number
    assert text.splitlines()[1:] == [
        f"child heard {number.name}",
        f"parent heard {number.name}",
        f"[ros2run]: Process exited with failure {code}",
    ]


def test_a_killed_ros2_leaves_no_child(start, workspace):
    command = start("run", "my_robot", "listener", environment=workspace("listener", LISTENER))
    command.wait_for("up")
    family = psutil.Process(command.process.pid).children(recursive=True)
    left = [each for each in family if "orphan_watch" not in command_of(each)]
    assert len(left) == 2
    command.process.kill()
    assert psutil.wait_procs(left, timeout=120)[1] == []
    assert "parent heard SIGINT" in command.wait()[1]


def test_signals_the_parent_ignores_are_heard_all_the_same(start, workspace):
    environment = workspace("listener", LISTENER)
    shell = ("sh", "-c", 'trap "" INT CHLD; exec "$@"', "sh", sys.executable, "-m", "gz_course.sim.ros.ros2")
    command = start("run", "my_robot", "listener", command=shell, environment=environment)
    command.wait_for("up")
    os.kill(command.process.pid, signal.SIGINT)
    assert command.wait()[0] == signal.SIGINT


def test_on_a_terminal_the_keyboard_reaches_the_child_and_ctrl_c_only_once(start, workspace):
    code = """\
import signal, sys
signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT, signal.SIGTERM])
print("got", input("up\\n"), flush=True)
print("listening", flush=True)
signal.sigwait([signal.SIGINT])
print("interrupted", flush=True)
signal.sigwait([signal.SIGTERM])
sys.exit(f"heard {1 + (signal.SIGINT in signal.sigpending())}")
"""
    environment = workspace("keys", f"#!{sys.executable}\n{code}")
    terminal = (
        sys.executable,
        "-c",
        "import os, pty, sys; sys.exit(os.waitstatus_to_exitcode(pty.spawn(sys.argv[1:])))",
    )
    command = start(
        *(sys.executable, "-m", "gz_course.sim.ros.ros2", "run", "my_robot", "keys"),
        command=terminal,
        environment=environment,
        stdin=subprocess.PIPE,
    )
    command.wait_for("up")
    command.process.stdin.write("key\n")
    command.process.stdin.flush()
    command.wait_for("listening")
    command.process.stdin.write("\x03")
    command.process.stdin.flush()
    command.wait_for("interrupted")
    # pty.spawn's child is ros2 run: the only child of the terminal process.
    pid = command.process.pid
    with open(f"/proc/{pid}/task/{pid}/children") as file:  # noqa: PTH123
        os.kill(int(file.read()), signal.SIGTERM)
    ended, text, _ = command.wait()
    assert (ended, "got key" in text, "heard 1" in text) == (1, True, True)


def test_the_bridge_runs_by_its_textbook_name(start, ros_domain):
    command = start(
        *("run", "ros_gz_bridge", "parameter_bridge", "/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"),
        environment={"GZ_IP": "127.0.0.1", "GZ_PARTITION": f"test-{os.getpid()}", "PATH": "/usr/bin:/bin"},
    )
    command.wait_for("ready: 1 bridge", "stderr")
    os.kill(command.process.pid, signal.SIGINT)
    assert command.wait()[0] == 0
