"""Signals end a launch in every state, and no process remains."""

import contextlib
import os
import signal
import subprocess
import sys

import psutil
import pytest

from gz_course.sim.launch.actions import LogInfo
from gz_course.sim.launch.substitutions import Command


def living_with(name, value):
    """Return the processes that have this environment variable."""
    found = []
    for process in psutil.process_iter():
        with contextlib.suppress(psutil.Error):
            if process.environ().get(name) == value and process.status() != psutil.STATUS_ZOMBIE:
                found.append(process)
    return found


INTERRUPTED = """\
import os, signal, sys, threading
from launch import *
from launch.actions import *
from launch.substitutions import *
{setup}
service = LaunchService()
service.include_launch_description(LaunchDescription([{entities}]))
sys.exit(service.run())
"""


@pytest.mark.parametrize(
    "entities",
    [
        "OpaqueFunction(function=lambda context: forever())",
        "LogInfo(msg='up'), LogInfo(msg=Command('sleep 1000'))",
        "ExecuteProcess(cmd=['sh', '-c', 'echo up; exec sleep 1000'], output='screen')",
    ],
)
@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 0), (signal.SIGTERM, 1), (signal.SIGHUP, 1), (signal.SIGQUIT, 1)]
)
def test_signals_end_it_whatever_it_does(tmp_path, entities, number, code):
    setup = "def forever():\n    print('up', flush=True)\n    while True: pass"
    program = INTERRUPTED.format(setup=setup, entities=entities)
    with subprocess.Popen(
        # The parent ignores SIGINT, as after the & of a shell.
        ["sh", "-c", 'trap "" INT; exec "$@"', "sh", sys.executable, "-c", program],
        env={**os.environ, "ROS_LOG_DIR": str(tmp_path)},  # which marks all processes of this test
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        stdin=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
    ) as process:
        try:
            for line in process.stdout:
                if line.rstrip().endswith("up"):
                    break
            process.send_signal(number)
            rest, _ = process.communicate(timeout=120)  # until the last process with its output has ended
        finally:
            left = living_with("ROS_LOG_DIR", str(tmp_path))
            for each in left:
                each.kill()
    assert (process.returncode, "Traceback" in rest) == (code, False), rest
    assert left == []
    wanted = "user interrupted with ctrl-c (SIGINT)" if number == signal.SIGINT else f"received {number.name}"
    assert f"[WARNING] [launch]: {wanted}" in rest


def test_a_command_that_is_interrupted_while_it_starts_is_ended(run, monkeypatch):
    started = []

    class Interrupted(subprocess.Popen):
        def __init__(self, *arguments, **options):
            super().__init__(*arguments, **options)
            started.append(self)
            os.kill(os.getpid(), signal.SIGINT)

    monkeypatch.setattr("gz_course.sim.launch.substitutions.command.subprocess.Popen", Interrupted)
    result = run(LogInfo(msg=Command("sleep 1000")), LogInfo(msg="not reached"))
    assert result.code == 0
    assert result.lines == ["[WARNING] [launch]: user interrupted with ctrl-c (SIGINT)"]
    (process,) = started
    assert process.returncode == -signal.SIGKILL
