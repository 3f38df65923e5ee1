"""The process from which the gradings of a class are forked: it has done the imports, and does nothing else.

`forked_process.py` runs it as `python -m gz_course.grader.whole_class.fork_server PARENT DESCRIPTOR ROOM` and sends an
order for each grading: folder, arguments of `course`, environment. Each grading is a process of its own, which keeps
modules and nothing else: this process never reads a submission, and what a grading does stays in it.

A grading is a child of PARENT, not of this process, so that it goes on should this process be killed: it is forked by a
process in between, which ends at once; PARENT is a subreaper. Only then the grading begins, as it asks for a signal at
the end of its parent.

Modules may have threads (NumPy, Arrow, Rerun, LTTng), which a fork leaves behind. They are at rest here, so that they
hold no lock, and what a grading needs of them is started again in it.

Source: fork(2), prctl(2) (PR_SET_CHILD_SUBREAPER, PR_SET_PDEATHSIG)
"""

from __future__ import annotations

import contextlib
import ctypes
import importlib
import json
import os
import pkgutil
import signal
import sys
import tempfile
import time
import traceback
from multiprocessing.connection import Connection
from pathlib import Path
from types import ModuleType
from typing import Any, NoReturn

from gz_course.grader.process.forking import fork
from gz_course.grader.process.many_imports import many_imports
from gz_course.grader.run.agent.course_agent.import_hooks import leave_out_generator

PR_SET_PDEATHSIG = 1
LOOK_AGAIN = 0.001  # [s] between two looks at threads that are still at work
# What gradings import. Not `commands.grade`, which looks at the clock as it is imported.
MODULES = (
    "gz_course.grader.course",
    "gz_course.grader.grade",
    "gz_course.grader.process.command_line",
    "gz_course.grader.record.recorder",
    "gz_course.grader.report.best",
    "gz_course.grader.report.outputs",
    "gz_course.grader.report.terminal",
    "gz_course.grader.report.verdicts",
    "gz_course.grader.run.exercise_bridge",
    "gz_course.grader.run.properties",
    "gz_course.grader.run.run_loop",
    "gz_course.grader.run.session",
    "numpy.ma",
    "numpy.random",
    "pydantic.fields",  # for typer
    "pydantic.type_adapter",
    "rclpy.action",
    "rerun.chunk",
    "rosidl_generator_py",
)
# Packages of which gradings import any part.
PACKAGES = (
    "gz_course.grader.kinds",
    "gz_course.grader.report.formats",
    "gz_course.grader.run.sandbox.levels",
    "gz_course.grader.score",
    "gz_course.sim.gz.sim.editing",
    "gz_course.sim.gz.sim.sensors",
    "gz_course.sim.gz.sim.systems",
    "gz_course.sim.bridge.ros_gz_bridge",
)


def main() -> NoReturn:
    """Fork gradings until the starter closes its end."""
    parent, channel = int(sys.argv[1]), Connection(int(sys.argv[2]))
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the starter, which ends the gradings
    try:
        load()
        channel.send_bytes(_answer())
        while True:
            order = json.loads(channel.recv_bytes())
            if fork_for(parent, channel):
                grade(order)
    except (EOFError, ConnectionError):
        os._exit(0)
    except Exception as error:
        with contextlib.suppress(OSError):
            channel.send_bytes(_answer(error=f"{type(error).__name__}: {error}"))
        os._exit(1)


def _answer(**content: Any) -> bytes:
    return json.dumps(content).encode()


def load() -> None:
    """Import what gradings import."""
    with many_imports():
        leave_out_generator()
        _import_all()


def _import_all() -> None:
    from gz_course.grader.report.format import formats
    from gz_course.sim.gz import msgs as gz_messages
    from gz_course.sim.gz.msgs import registry

    for name in MODULES:
        importlib.import_module(name)
    for name in PACKAGES:
        package = importlib.import_module(name)
        for found in pkgutil.walk_packages(package.__path__, f"{name}."):
            importlib.import_module(found.name)
    for path in registry.PROTO_FOLDER.glob("*.proto"):
        importlib.import_module(f"{gz_messages.__name__}.{path.stem}_pb2")
    for each in formats().values():
        each.prepare()
    for name, module in list(sys.modules.items()):
        if name.endswith((".msg", ".srv")):  # their compiled parts are loaded as late as their classes are used
            load_compiled(module)


def load_compiled(package: ModuleType) -> None:
    """Load the compiled part of a package of ROS interfaces."""
    for found in vars(package).values():
        if load := getattr(type(found), "__import_type_support__", None):  # of the class of message classes
            load()
            break


def fork_for(parent: int, channel: Connection) -> bool:
    """Fork a new child of `parent` and tell its number; return True in the child, False here."""
    _at_rest()
    told, tell = os.pipe()
    wait, begin = os.pipe()
    between = fork()
    if between == 0:
        _in_between(parent, channel, told, tell, wait, begin)
        return True
    os.close(tell)
    os.close(wait)
    number = os.read(told, 100)
    os.waitpid(between, 0)
    if number.isdigit():
        channel.send_bytes(_answer(pid=int(number)))
        os.write(begin, b"+")  # after it is known, and has got its parent
    else:
        channel.send_bytes(_answer(error=number.decode() or "a fork ended at once"))
    os.close(told)
    os.close(begin)
    return False


def _in_between(parent: int, channel: Connection, told: int, tell: int, wait: int, begin: int) -> None:
    """Fork once more and end; return in the child when it has got its parent."""
    try:
        os.close(told)
        os.close(begin)
        if fork():
            os._exit(0)
        os.setsid()
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        channel.close()
        os.write(tell, b"%d" % os.getpid())  # the starter may send signals from now on
        os.close(tell)
        if not os.read(wait, 1):
            os._exit(3)
        os.close(wait)
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)  # `course` closes everything on SIGTERM
        if os.getppid() != parent:
            os._exit(3)
    except OSError as error:
        with contextlib.suppress(OSError):
            os.write(tell, str(error.strerror).encode())
        os._exit(3)


def _at_rest() -> None:
    """Wait until the threads of modules wait: at work they could hold a lock that a fork would never get."""
    for task in Path("/proc/self/task").iterdir():
        while task.name != str(os.getpid()):
            try:
                state = (task / "stat").read_bytes().rpartition(b")")[2].split()[0]
            except OSError:
                break
            if state == b"S":
                break
            time.sleep(LOOK_AGAIN)


def grade(order: dict[str, Any]) -> NoReturn:
    """Become `course` with the folder, environment and arguments of an order; errors go to the folder's `stderr`."""
    from gz_course.grader.course import main as course
    from gz_course.grader.process.command_line import show

    code = 3
    try:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        os.chdir(order["folder"])
        errors = os.open("stderr", os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600)
        os.dup2(errors, 2)
        os.close(errors)
        os.environ.clear()
        os.environ.update(order["environment"])
        tempfile.tempdir = None  # it is found anew in this environment
        show("course", *order["arguments"][:1], order["folder"])
        sys.argv = ["course", *order["arguments"]]
        course()
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        traceback.print_exc()
    finally:
        with contextlib.suppress(Exception):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(code)


if __name__ == "__main__":
    main()
