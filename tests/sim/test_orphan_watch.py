"""A launch that is killed leaves no orphans."""

import multiprocessing
import os
import signal
import subprocess
import sys

import psutil
import pytest

from gz_course.sim import orphan_watch
from gz_course.sim.ros.launch.actions import ExecuteProcess, OpaqueFunction, RegisterEventHandler, Shutdown
from gz_course.sim.ros.launch.event_handlers import OnProcessStart
from gz_course.tests.sim.command_line import command_of
from gz_course.tests.sim.ros.launch.conftest import log_folder, run  # noqa: F401

KILLED = """\
import sys
from launch import *
from launch.actions import *
service = LaunchService()
service.include_launch_description(LaunchDescription([
    ExecuteProcess(cmd=["true"]),
    ExecuteProcess(cmd=[sys.executable + " -S -c 'import signal; print(\\"up\\", flush=True); signal.pause()'; true"],
                   shell=True, output="screen"),
    ExecuteProcess(cmd=[sys.executable, "-S", "-c", "import signal; print('up', flush=True); signal.pause()"],
                   respawn=True, output="screen"),
]))
service.run()
"""


# The tests may have been started with SIGINT ignored, as by the & of a shell.
STUBBORN = """\
import signal
for name in ("SIGINT", "SIGTERM"):
    signal.signal(signal.Signals[name], signal.SIG_IGN if name in {} else signal.SIG_DFL)
print("up", flush=True)
while True:
    signal.pause()
"""


def all_watchers():
    return {each.pid for each in psutil.Process().children() if "orphan_watch" in command_of(each)}


@pytest.fixture
def watchers():
    """Return a function that finds the watcher processes started since the beginning of the test."""
    before = all_watchers()
    return lambda: all_watchers() - before


def test_sigkill_leaves_no_orphan(tmp_path):
    with subprocess.Popen(
        [sys.executable, "-c", KILLED],
        env={**os.environ, "ROS_LOG_DIR": str(tmp_path)},
        stdout=subprocess.PIPE,
        stdin=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
    ) as process:
        ups = 0
        for line in process.stdout:
            ups += line.rstrip().endswith("up")
            if ups == 2:
                break
        family = psutil.Process(process.pid).children(recursive=True)
        children = [each for each in family if each.name().startswith("python")]
        os.killpg(process.pid, signal.SIGKILL)
        assert len(children) == 2
        try:
            _, living = psutil.wait_procs(children, timeout=120)
            assert living == []
        finally:
            for each in children:
                if each.is_running():
                    each.kill()


@pytest.mark.parametrize(
    ("ignored", "patience", "end"),
    # The time limit is not reached if the signal works, but it must be long enough for a busy machine.
    [((), 300, -signal.SIGINT), (("SIGINT",), 10, -signal.SIGTERM), (("SIGINT", "SIGTERM"), 2, -signal.SIGKILL)],
)
def test_it_escalates(ignored, patience, end):
    with (
        subprocess.Popen([sys.executable, "-S", "-c", STUBBORN.format(ignored)], process_group=0, stdout=-1) as child,
        subprocess.Popen(
            ["sh", "-c", orphan_watch.SCRIPT, "sh", str(patience)], stdin=-1, stderr=-3, text=True
        ) as watch,
    ):
        assert child.stdout.readline() == b"up\n"
        gone = subprocess.Popen(["true"], process_group=0)
        gone.wait(120)
        watch.stdin.write(f"+ -{gone.pid}\n+ -{child.pid}\n- -{gone.pid}\n")
        watch.stdin.close()
        assert child.wait(120) == end


def test_who_has_ended_is_left_alone():
    with (
        subprocess.Popen(["sleep", "1000"], process_group=0) as other,
        subprocess.Popen(["sh", "-c", orphan_watch.SCRIPT, "sh", "2"], stdin=-1, text=True) as watch,
    ):
        watch.communicate(f"+ -{other.pid}\n- -{other.pid}\n", timeout=120)
        assert (watch.returncode, other.poll()) == (0, None)
        other.kill()


def test_it_lives_as_long_as_there_are_processes(run, watchers):  # noqa: F811
    seen = []

    def look(context):
        seen.append(len(watchers()))

    started = OnProcessStart(on_start=[OpaqueFunction(function=look), Shutdown()])
    run(RegisterEventHandler(started), ExecuteProcess(cmd=["sleep", "1000"]))
    assert seen == [1]
    assert watchers() == set()


def test_a_fork_does_not_keep_it(watchers):
    with subprocess.Popen(["sleep", "1000"], process_group=0) as child:
        orphan_watch.watch(child.pid)
        fork = multiprocessing.get_context("fork").Process(target=signal.pause)
        fork.start()
        try:
            orphan_watch.unwatch(child.pid)  # waits for the shell, which reads until the pipe is closed
            assert watchers() == set()
        finally:
            for each in (fork, child):
                each.kill()
            fork.join(120)
