"""Questions to the grader: who waits for an answer is at work, and who runs an event loop asks for the run's clock."""

import subprocess
import sys

ASK = """
import threading
from pathlib import Path
from types import SimpleNamespace
from gz_course.grader.run.agent.course_agent import python_3_threads, thread_monitor
from gz_course.grader.run.agent.course_agent.thread_monitor import ThreadMonitor

asked = []
thread_monitor.SHORTEST_LOOK = 0.0

def answer():
    status = Path(f"/proc/self/task/{asking}/stat")
    while not asked or status.read_text().rpartition(")")[2].split()[0] != "S":
        pass
    for _ in range(2):
        monitor.look_for_strays({threading.main_thread().ident: asking})
    idle.append(monitor.idle)
    grader_requests.hear({"answer": {"done": True}})

asking = threading.get_native_id()
monitor, idle = ThreadMonitor(), []
answering = threading.Thread(target=answer)
answering.start()
python_3_threads.install_threads(monitor)
from gz_course.grader.run.agent.course_agent import grader_requests

grader_requests.channel = lambda: SimpleNamespace(send=asked.append, listening=True)
assert grader_requests.ask({"worlds": True}) == {"done": True}
print(idle)
"""


def test_who_waits_for_an_answer_is_at_work():
    done = subprocess.run([sys.executable, "-c", ASK], capture_output=True, text=True, timeout=300)
    assert (done.stdout.strip(), done.stderr) == ("[False]", "")


LOOP = """
import asyncio, subprocess, sys, time
from gz_course.grader.run.agent.course_agent import grader_requests, python_3
from types import SimpleNamespace

delayed, asked = iter([7.0, 7.1, 7.2, *[7.3] * 100]), []
orders = [{"ping": True}]  # what nobody listens to is skipped

def receive():
    return orders.pop() if orders else {"answer": {"now": 1.0, "delayed": next(delayed)}}

stub = SimpleNamespace(open=True, listening=False, send=asked.append, receive=receive)
python_3.channel = grader_requests.channel = lambda: stub
python_3.install_asyncio()
began = time.monotonic()
asyncio.run(asyncio.sleep(0.05))
print(time.monotonic() - began >= 0.35, asked[0], 4 <= asked.count({"time": True}) < 20)
delayed = iter([0.0] + [1000.0] * 1000)
python_3.install_subprocess()
python_3._delayed.clear()
print(subprocess.run([sys.executable, "-I", "-S", "-c", "import time; time.sleep(0.1)"], timeout=0.01).returncode)
"""


def test_timers_of_an_event_loop_and_timeouts_for_a_child_do_not_count_what_a_busy_machine_takes():
    """Such as those of a launch, which escalates some seconds after Ctrl-C."""
    done = subprocess.run([sys.executable, "-c", LOOP], capture_output=True, text=True, timeout=300)
    assert (done.stdout.strip(), done.stderr) == ("True {'time': True} True\n0", "")
