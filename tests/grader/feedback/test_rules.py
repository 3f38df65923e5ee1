"""A rule is found where its file lies; one that raises is named, and all others are asked."""

import ast
import inspect
from collections.abc import Callable, Iterator
from types import ModuleType
from typing import get_type_hints

import numpy as np
import pytest

from gz_course.grader.feedback import errors, launch_files, slips, suspects
from gz_course.grader.feedback.errors.launch_errors import launch_meaning
from gz_course.grader.feedback.errors.python_errors import meaning
from gz_course.grader.feedback.facts.syntax import DEEPEST, Place, Words, places_in
from gz_course.grader.feedback.launch_files import launch_places
from gz_course.grader.feedback.predictions import answers, commands, tables
from gz_course.grader.feedback.predictions.of_robots.creating import odd_mass
from gz_course.grader.feedback.rules import Fault, Room, as_facts, ask, faults_kept, guarded, recorded_faults
from gz_course.grader.feedback.suspects.about import About, Suspect
from gz_course.grader.registry import modules_below

NODE = b"import rclpy\nrclpy.spin\n"
ROOMS = {
    "slips": slips.ROOM, "slips of a run": slips.OF_RUNS, "suspects": suspects.ROOM, "launch files": launch_files.ROOM,
    "errors": errors.ROOM, "answers": answers.ROOM, "notices": answers.NOTICES, "commands": commands.ROOM,
    "tables": tables.ROOM,
}  # fmt: skip
SIGNED = {
    "slips": ("gz_course.grader.feedback.slips import slip as rule", "tree", "yield 1, 'dropped'"),
    "slips of a run": ("gz_course.grader.feedback.slips import slip_of_run as rule", "tree, run", "yield 1, 'dropped'"),
    "suspects": (
        "gz_course.grader.feedback.suspects import suspicion as rule",
        "tree",
        "yield 1, 'limit', 'dropped'",
    ),
    "launch files": (
        "gz_course.grader.feedback.launch_files import launch_slip as rule",
        "file",
        "yield 1, 'dropped'",
    ),
    "errors": ("gz_course.grader.feedback.errors import explanation as rule", "error, code", "return 'dropped'"),
    "answers": (
        "gz_course.grader.feedback.predictions.answers import predicts\nrule = predicts('dropped', rank=0)",
        "asked",
        "return asked.given",
    ),
    "notices": (
        "gz_course.grader.feedback.predictions.answers import notices as rule",
        "asked",
        "return 'dropped'",
    ),
    "commands": (
        "gz_course.grader.feedback.predictions.commands import explains as rule",
        "drive",
        "return 'dropped'",
    ),
    "tables": (
        "gz_course.grader.feedback.predictions.tables import explains_column\nrule = explains_column('odd')",
        "column",
        "return 'dropped'",
    ),
}


def source(room: str, body: str = "") -> str:
    imports, given, said = SIGNED[room]
    return f"from {imports}\n\n\n@rule\ndef dropped({given}):\n    {body or said}\n"


def said(room: str) -> str:
    """Return what the room says of something of which no rule that stays says anything, but for `rclpy.spin`."""
    times = np.arange(6.0)
    asked = answers.Asked("minimum", times, times + 1, times * 7.77 + 0.123, np.ones(6, bool), 1e-6)
    drive = commands.Drive(times, np.zeros((6, 3)), np.zeros((6, 3)), 6.0, 0.5, 5.0)
    found = {
        "slips": lambda: slips.slips(NODE),
        "slips of a run": lambda: slips.slips(NODE),
        "suspects": lambda: suspects.suspects(NODE),
        "launch files": lambda: launch_places(NODE),
        "errors": lambda: meaning("OddError: nobody knows it"),
        "answers": lambda: answers.explain(asked),
        "notices": lambda: answers.explain(asked),
        "commands": lambda: commands.explain(drive),
        "tables": lambda: tables.explain_column("odd", [], [], ()),
    }
    return str(found[room]())


@pytest.mark.parametrize("room", ROOMS)
def test_a_file_is_found_without_a_list(room, drop):
    assert "dropped" not in said(room)
    drop(ROOMS[room].package, "a_dropped_file", source(room), ROOMS[room])
    assert "dropped" in said(room)


@pytest.mark.parametrize("error", ["RuntimeError('odd')", "RecursionError('deep')", "KeyError('key')"])
@pytest.mark.parametrize("room", ROOMS)
def test_a_rule_that_raises_is_named_and_the_others_are_asked(room, error, drop):
    before, body = said(room), f"raise {error}" + "\n    yield" * SIGNED[room][2].startswith("yield")
    drop(ROOMS[room].package, "a_dropped_file", source(room, body), ROOMS[room])
    with faults_kept() as faults:
        assert said(room) == before
    (fault,) = faults
    assert fault.rule.endswith("a_dropped_file.dropped") and error.partition("(")[0] in fault.error
    assert fault.rule in str(fault) and "instructor" in str(fault)


def test_memory_is_no_fault_of_a_rule():
    def rule() -> str:
        raise MemoryError

    with faults_kept() as faults, pytest.raises(MemoryError):
        ask(rule, "")
    assert faults == []


def test_outside_of_a_grading_the_error_is_raised():
    @guarded("")
    def rule() -> str:
        raise ValueError("odd")

    with pytest.raises(ValueError, match="odd"):
        rule()
    with faults_kept() as faults:
        assert rule() == "" == rule()
    assert len(faults) == 1
    assert recorded_faults(as_facts(faults)) == faults
    assert as_facts([]) == {} and recorded_faults({}) == []


def test_rules_that_are_called_by_their_names_are_guarded():
    with faults_kept() as faults:
        assert odd_mass(None) == "" and launch_meaning(None) == ""
        assert places_in(b"x = 1", lambda tree: tree.nothing) == []
    assert [each.rule.rpartition(".")[2] for each in faults][:2] == ["odd_mass", "launch_meaning"]
    assert len(faults) == 3 and all(isinstance(each, Fault) for each in faults)


def test_what_is_nested_too_deeply_is_not_looked_at():
    deep = b"x = " + b"-" * (DEEPEST + 10) + b"1\n"
    assert places_in(deep, lambda tree: [{"line": 1}]) == []
    assert places_in(b"x = " + b"-" * 20 + b"1\n", lambda tree: [{"line": 1}]) != []


def test_a_rule_in_no_room_cannot_exist():
    def stray(tree):
        yield 1, "stray"

    with pytest.raises(ValueError, match=r"stray is a rule, but in no file of .*slips"):
        slips.slip(stray)
    with pytest.raises(ValueError, match="in no file of"):
        Room("gz_course.grader.feedback.errors").add(stray, stray)


def test_a_file_stands_before_files_that_exist(drop):
    drop(slips.ROOM.package, "a_dropped_file", "BEFORE = ('nothing_like_that',)\n" + source("slips"), slips.ROOM)
    with pytest.raises(ValueError, match="nothing_like_that"):
        slips.ROOM.rules()


def test_two_files_of_a_room_have_two_names(drop):
    drop(slips.ROOM.package, "everyday", source("slips"), slips.ROOM)
    with pytest.raises(ValueError, match=r"two files of .* are called everyday"):
        slips.ROOM.rules()


def public_rules(package: ModuleType, finding: object) -> Iterator[tuple[str, Callable]]:
    """Yield the public functions of a room that yield findings, as a rule does."""
    for module in modules_below(package):
        for name, function in vars(module).items():
            own = inspect.isfunction(function) and function.__module__ == module.__name__
            if own and not name.startswith("_"):
                names = vars(module) | {"ast": ast}
                if get_type_hints(function, names).get("return") in (Iterator[finding], Words):
                    yield f"{module.__name__}.{name}", function


@pytest.mark.parametrize(("package", "finding", "room"), [
    (slips, Place, slips.ROOM), (suspects, Suspect, suspects.ROOM), (launch_files, Place, launch_files.ROOM),
])  # fmt: skip
def test_no_rule_was_forgotten(package, finding, room):
    registered = {*room.rules(), *(slips.OF_RUNS.rules() if room is slips.ROOM else ())}
    public = dict(public_rules(package, finding))
    assert len(public) > 20
    assert [name for name, function in public.items() if function not in registered] == []


def test_suspects_are_about_what_the_list_has():
    assert len(About) == len({each.value for each in About}) > 90
    assert About.PARAMETER.of("speed") == "parameter speed"
