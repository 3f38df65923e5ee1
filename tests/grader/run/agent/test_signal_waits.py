"""Who waits for a signal is not at work."""

import subprocess
import sys

import pytest

WAIT = """
import _thread, os, signal, sys
from gz_course.grader.run.agent.course_agent import python_3_threads
from gz_course.grader.run.agent.course_agent.thread_monitor import ThreadMonitor

monitor, main, said = ThreadMonitor(), _thread.get_ident(), []
idle, ended = _thread.allocate_lock(), _thread.allocate_lock()
idle.acquire(), ended.acquire()
monitor.on_idle = lambda: idle.locked() and idle.release()

def end():
    said.append(idle.acquire(True, 300))
    while not ended.acquire(True, 0.01):  # a signal that comes just before pause() is lost
        signal.pthread_kill(main, signal.SIGUSR1)

signal.signal(signal.SIGUSR1, lambda *_: None)
python_3_threads.install_threads(monitor)
if CALL != "pause()":
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGUSR1})
_thread.start_new_thread(end, ())
at_work = not monitor.idle
eval(f"signal.{CALL}", {"signal": signal, "number": {signal.SIGUSR1}})
ended.release()
print(at_work, said, not monitor.idle)
"""


@pytest.mark.parametrize("call", ["sigtimedwait(number, 300)", "sigwait(number)", "sigwaitinfo(number)", "pause()"])
def test_who_waits_for_a_signal_is_at_rest(call):
    done = subprocess.run([sys.executable, "-c", f"CALL = {call!r}{WAIT}"], capture_output=True, text=True, timeout=600)
    assert (done.stdout.strip(), done.stderr) == ("True [True] True", "")
