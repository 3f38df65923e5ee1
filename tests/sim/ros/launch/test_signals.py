"""Signals end a launch in every state, and no process remains."""

import asyncio
import contextlib
import gc
import os
import signal
import subprocess
import sys

import psutil
import pytest

from gz_course.sim.ros.launch.actions import ExecuteProcess, LogInfo, OpaqueCoroutine, RegisterEventHandler
from gz_course.sim.ros.launch.event_handlers import OnProcessStart, OnShutdown
from gz_course.sim.ros.launch.substitutions import Command


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


ELSEWHERE = """
def deaf():
    main = threading.main_thread().native_id
    while open(f"/proc/self/task/{main}/stat").read().rpartition(")")[2].split()[0] != "S":
        pass
    signal.pthread_kill(threading.get_ident(), signal.SIGQUIT)
"""


def test_a_signal_that_another_thread_gets_wakes_the_run():
    """The same as one that comes just before the loop begins to wait: nothing else wakes it."""
    start = "OpaqueFunction(function=lambda context: threading.Thread(target=deaf).start())"
    program = INTERRUPTED.format(setup=ELSEWHERE, entities=f"{start}, TimerAction(period=1000.0, actions=[])")
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=False)
    assert "received SIGQUIT: shutting down" in done.stdout + done.stderr
    assert done.returncode == 1


def test_a_command_that_is_interrupted_while_it_starts_is_ended(run, monkeypatch):
    started = []

    class Interrupted(subprocess.Popen):
        def __init__(self, *arguments, **options):
            super().__init__(*arguments, **options)
            started.append(self)
            os.kill(os.getpid(), signal.SIGINT)

    monkeypatch.setattr("gz_course.sim.ros.launch.substitutions.command.subprocess.Popen", Interrupted)
    result = run(LogInfo(msg=Command("sleep 1000")), LogInfo(msg="not reached"))
    assert result.code == 0
    assert result.lines == ["[WARNING] [launch]: user interrupted with ctrl-c (SIGINT)"]
    (process,) = started
    assert process.returncode == -signal.SIGKILL


def interrupt(times=1):
    for _ in range(times):
        os.kill(os.getpid(), signal.SIGINT)


@pytest.mark.parametrize("action", ["process", "coroutine"])
def test_what_is_interrupted_while_it_is_scheduled_is_ended(run, monkeypatch, caplog, action):
    async def forever():
        await asyncio.Event().wait()

    actions = {
        "process": ExecuteProcess(cmd=["sleep", "1000"]),
        "coroutine": OpaqueCoroutine(coroutine=forever, ignore_context=True),
    }
    create_task, call_soon = asyncio.BaseEventLoop.create_task, asyncio.BaseEventLoop.call_soon
    scheduling = []

    def create(loop, work, **options):
        scheduling.append(work.__qualname__ in ("ExecuteLocal._run", "OpaqueCoroutine._run"))
        return create_task(loop, work, **options)

    def call(loop, *arguments, **options):
        if scheduling and scheduling.pop():
            interrupt()  # the task is made but not yet scheduled
        return call_soon(loop, *arguments, **options)

    monkeypatch.setattr(asyncio.BaseEventLoop, "create_task", create)
    monkeypatch.setattr(asyncio.BaseEventLoop, "call_soon", call)
    result = run(actions[action], LogInfo(msg="not reached"))
    assert result.code == 0
    assert "[WARNING] [launch]: user interrupted with ctrl-c (SIGINT)" in result.lines
    assert not any("not reached" in line for line in result.lines)
    gc.collect()  # which would warn of a coroutine that was never awaited
    assert caplog.messages == []


@pytest.mark.parametrize(("times", "hangs"), [(1, False), (2, False), (2, True)])
def test_a_second_interruption_during_the_shutdown_keeps_no_process_from_its_end(run, times, hangs):
    """The handler of the shutdown is visited before the one of the process."""

    def on_shutdown(event, context):
        interrupt(times)
        while hangs:
            pass

    process = ExecuteProcess(cmd=["sleep", "1000"])
    stops = RegisterEventHandler(OnProcessStart(target_action=process, on_start=lambda event, context: interrupt()))
    result = run(stops, process, RegisterEventHandler(OnShutdown(on_shutdown=on_shutdown)))
    assert result.code == 0
    again = "[WARNING] [launch]: user interrupted with ctrl-c (SIGINT) again, ignoring..."
    assert result.lines.count(again) == 1
    assert any("process has died" in line for line in result.lines)
