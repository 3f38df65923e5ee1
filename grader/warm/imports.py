"""What gradings import: a process that has loaded it forks gradings which begin at once.

Modules may have threads (NumPy, Arrow, Rerun, LTTng), which a fork leaves behind. They are at rest when it happens, so
that they hold no lock, and what a grading needs of them is started again in it.
"""

from __future__ import annotations

import importlib
import os
import pkgutil
import sys
import time
from pathlib import Path
from types import ModuleType

from gz_course.grader.process.many_imports import many_imports
from gz_course.grader.run.agent.course_agent.import_hooks import leave_out_generator

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
    "gz_course.grader.feedback",
    "gz_course.grader.kinds",
    "gz_course.grader.report.formats",
    "gz_course.grader.run.sandbox.levels",
    "gz_course.grader.score",
    "gz_course.sim.gz.sim.editing",
    "gz_course.sim.gz.sim.sensors",
    "gz_course.sim.gz.sim.systems",
    "gz_course.sim.bridge.ros_gz_bridge",
)


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


def wait_for_rest() -> None:
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
