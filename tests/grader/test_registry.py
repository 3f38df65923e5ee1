"""Registries that are folders: what is in them, and in which order."""

from graphlib import CycleError

import pytest

from gz_course.grader import commands, registry
from gz_course.grader.registry import in_order, module_names
from gz_course.grader.report import formats


def test_the_modules_of_a_folder_are_found_without_those_that_begin_with_an_underscore():
    found = module_names(formats)
    assert {"gradescope", "html", "json", "junit"} <= set(found) and found == sorted(found)
    assert "grade_all" in module_names(commands) and "__init__" not in module_names(commands)
    assert registry.modules(formats)["json"].FORMAT.file == "report.json"


def test_the_alphabet_orders_what_nothing_else_does():
    assert in_order({"c": (), "a": (), "b": ()}) == ["a", "b", "c"]
    assert in_order({"a": (), "b": ("a",), "c": ("b",), "d": ()}) == ["c", "b", "a", "d"]


def test_an_unknown_name_is_an_error_with_the_nearest_one():
    with pytest.raises(ValueError, match=r"'no_clok', which does not exist; did you mean 'no_clock'\?"):
        in_order({"a": ("no_clok",), "no_clock": ()})


def test_a_cycle_is_an_error():
    with pytest.raises(CycleError):
        in_order({"a": ("b",), "b": ("a",)})
