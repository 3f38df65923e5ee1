"""A process that waits for an answer of the grader is at work, so that simulated time does not go on without it."""

import subprocess
import sys

ASK = """
import threading
from pathlib import Path
from types import SimpleNamespace
from gz_course.grader.run.agent.course_agent import python_3
from gz_course.grader.run.agent.course_agent.thread_monitor import ThreadMonitor

asked = []

def answer():
    status = Path(f"/proc/self/task/{asking}/stat")
    while not asked or status.read_text().rpartition(")")[2].split()[0] != "S":
        pass
    monitor.look_for_strays({threading.main_thread().ident: asking})
    monitor.look_for_strays({threading.main_thread().ident: asking})
    idle.append(monitor.idle)
    grader_requests.hear({"answer": {"done": True}})

asking = threading.get_native_id()
monitor, idle = ThreadMonitor(), []
answering = threading.Thread(target=answer)
answering.start()
python_3.install_threads(monitor)
from gz_course.grader.run.agent.course_agent import grader_requests

grader_requests.channel = lambda: SimpleNamespace(send=asked.append)
assert grader_requests.ask({"worlds": True}) == {"done": True}
print(idle)
"""


def test_who_waits_for_an_answer_is_at_work():
    done = subprocess.run([sys.executable, "-c", ASK], capture_output=True, text=True, timeout=300)
    assert (done.stdout.strip(), done.stderr) == ("[False]", "")
