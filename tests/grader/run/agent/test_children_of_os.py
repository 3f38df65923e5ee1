"""A process that starts others without `subprocess`, as `ros2 run` does, is announced with them, and as waiting."""

import subprocess
import sys

import pytest

BEGIN = """
import os, signal, sys
from types import SimpleNamespace
from gz_course.grader.run.agent.course_agent import python_3, python_3_os

def told():
    "Say what was told so far, with `child` for the number of the child."
    words = [key + ("" if value is True else f" {value.get('program', value.get('code'))}")
             for message in said for key, value in message.items()]
    return [word.replace(os.path.basename(os.path.realpath(sys.executable)), "python") for word in words]

said = []
python_3.channel = lambda: SimpleNamespace(open=True, send=said.append)
python_3_os.install(lambda: python_3)
reading, writing = os.pipe()
CHILD = [sys.executable, "-c", f"import os; os.read({reading}, 1); os._exit(3)"]
ENVIRONMENT = {"COURSE_SOCKET": "/nowhere"}
os.set_inheritable(reading, True)
"""
WAITED = """
child = os.posix_spawn(CHILD[0], CHILD, ENVIRONMENT)
assert os.waitpid(child, os.WNOHANG) == (0, 0)
print(told())
class Writer:  # lets the child end once the wait has been told
    def append(self, message):
        list.append(heard, message)
        if "waiting" in message:
            os.write(writing, b"x")
heard = list(said)
python_3.channel = lambda: SimpleNamespace(open=True, send=Writer().append)
pid, status = os.waitpid(child, 0)
assert pid == child and os.waitstatus_to_exitcode(status) == 3
said = heard
print(told())
"""
RUN = """
import threading
from gz_course.sim.ros.ros2 import child
def append(message):
    said.append(message)
    if "waiting" in message:
        os.write(writing, b"x")
python_3.channel = lambda: SimpleNamespace(open=True, send=append)
os.environ.update(ENVIRONMENT)
assert child.run_child(CHILD) == 3
ours = [message["started"]["ours"] for message in said if "started" in message]
print(told(), ours)
"""
MUTE = """
child = os.posix_spawn("/bin/true", ["true"], {"HOME": "/"})
print(told())
import subprocess
assert subprocess.run(["true"]).returncode == 0
assert os.wait()[0] == child
print([word for word in told()[1:] if word != "waiting"])
"""


@pytest.mark.parametrize(
    ("program", "printed"),
    [
        (WAITED, "['started python']\n['started python', 'waiting', 'ended 3']\n"),
        (RUN, "['started python', 'waiting', 'awake', 'ended 3'] [True]\n"),
        (MUTE, "['started ']\n['ended 0']\n"),
    ],
)
def test_what_is_told(program, printed):
    done = subprocess.run([sys.executable, "-c", BEGIN + program], capture_output=True, text=True, timeout=600)
    assert (done.stdout, done.stderr) == (printed, "")
