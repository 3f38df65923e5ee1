"""Private names of libraries: each one that our code uses is known, and is there in the Python that runs the tests.

A new Python may drop a private name without a word. So each is in a table: that of the agent, which is checked when a
run begins, or the one here.
"""

import ast
import importlib
from functools import cache
from pathlib import Path

import pytest

from gz_course.grader.run.agent.course_agent import python_3, python_3_threads, rclpy_7_1, rclpy_7_1_actions

ROOT = Path(__file__).parents[1]
CHECKED = (
    rclpy_7_1.RELIED_UPON | rclpy_7_1_actions.RELIED_UPON
    | python_3.SUBPROCESS | python_3.ASYNCIO | python_3_threads.THREADS
)  # fmt: skip
# Where a private name is not in the table of the agent: the place in which it must be found.
FOUND = {
    "_PySimpleQueue": "queue:_PySimpleQueue",
    "_TYPE_SUPPORT": "std_msgs.msg:Empty._TYPE_SUPPORT",  # of every message of ROS
    "_TokenType": "pygments.token:_TokenType",
    "_callback_type": "rclpy.subscription:Subscription.CallbackType",  # of each subscription
    "_exit": "os:_exit",  # public, in spite of its name
    "_fields_and_field_types": "std_msgs.msg:Empty._fields_and_field_types",
    "_genfunctions": "_pytest.python:PyCollector._genfunctions",
    "_getframe": "sys:_getframe",
    "_gohlketransforms": "transforms3d._gohlketransforms:Arcball",
    "_queue": "_queue:SimpleQueue",
    "_signal": "_signal:signal",
    "_socket": "_socket:socket",
    "_thread": "_thread:allocate_lock",
    "_time": "threading:_time",
}
# The same for what only instances have, each made by a call without arguments.
FOUND_IN_INSTANCES = {
    "_cleanup": "unittest:TestSuite",
    "_is_owned": "threading:RLock",
    "_option_string_actions": "argparse:ArgumentParser",
    "_testMethodName": "unittest:TestCase",
}


def is_private(name: str) -> bool:
    return name.startswith("_") and not name.startswith("__")


@cache
def files() -> tuple[Path, ...]:
    return tuple(sorted({*ROOT.glob("sim/**/*.py"), *ROOT.glob("grader/**/*.py")}))


def own(tree: ast.AST) -> set[str]:
    """Return the names that a file itself gives to something."""
    names = set()
    for node in ast.walk(tree):
        match node:
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
                names.add(name)
            case ast.Name(id=name, ctx=ast.Store()) | ast.arg(arg=name):
                names.add(name)
            case ast.Attribute(value=ast.Name(id="self" | "cls"), attr=name, ctx=ast.Store()):
                names.add(name)
    return names


def attributes(tree: ast.AST) -> set[str]:
    return {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute) and is_private(node.attr)}


def imports(tree: ast.AST) -> set[str]:
    """Return the private parts of what a file imports from others than its own package."""
    names: set[str] = set()
    for node in ast.walk(tree):
        match node:
            case ast.Import(names=aliases):
                names |= {part for alias in aliases for part in alias.name.split(".")}
            case ast.ImportFrom(module=str(module), level=0, names=aliases) if not module.startswith("gz_course"):
                names |= {*module.split("."), *(alias.name for alias in aliases)}
    return {name for name in names if is_private(name)}


@cache
def of_libraries() -> dict[str, str]:
    """Return the private names that no file of ours defines, each with a file that uses it."""
    trees = {path: ast.parse(path.read_text()) for path in files()}
    defined = set().union(*map(own, trees.values()))
    return {
        name: str(path.relative_to(ROOT))
        for path, tree in trees.items()
        for name in attributes(tree) - defined | imports(tree)
    }


def in_agents_table(name: str) -> bool:
    return any(
        name in place.replace(":", ".").split(".") or name in names.split() for place, (_, names) in CHECKED.items()
    )


def test_every_private_name_of_a_library_is_known():
    unknown = {
        name: file
        for name, file in of_libraries().items()
        if name not in {*FOUND, *FOUND_IN_INSTANCES} and not in_agents_table(name)
    }
    assert unknown == {}, "add it to a table, or better: use what is public"


def test_no_entry_is_stale():
    assert {*FOUND, *FOUND_IN_INSTANCES} - {*of_libraries()} == set()


@pytest.mark.parametrize("place", sorted(set(FOUND.values())))
def test_what_the_table_names_is_there(place):
    module, _, path = place.partition(":")
    found = importlib.import_module(module)
    for part in path.split("."):
        found = getattr(found, part)


@pytest.mark.parametrize("name", sorted(FOUND_IN_INSTANCES))
def test_instances_have_the_name(name):
    module, _, path = FOUND_IN_INSTANCES[name].partition(":")
    assert hasattr(getattr(importlib.import_module(module), path)(), name)
