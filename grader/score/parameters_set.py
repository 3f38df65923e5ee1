"""Why a parameter that the grader wanted to set during a run was not set: the fault behind a node that ignores it."""

from __future__ import annotations

from typing import Any

from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording


def parameter_not_set(recording: Recording, facts: dict[str, Any]) -> str:
    """Name the first parameter that could not be set, with the command that shows the same in a terminal."""
    for each in facts.get("parameters_set", []):
        if each["outcome"] == "set":
            continue
        command = f"`ros2 param set {each['node']} {each['name']} {each['value']}` at {each['at']:g} s"
        nodes = facts.get("nodes", [])
        if each["outcome"] == "refused" and "undeclared" in each["reason"]:
            said = f"was refused, because the node has not declared that parameter: {_declaration(each)} in __init__"
        elif each["outcome"] == "refused":
            said = (
                f"was refused: {each['reason']}"
                if each["reason"]
                else f"was refused, without a reason{_refusal(facts)}"
            )
            if "invalid type" in each["reason"]:
                said += (
                    ". The function given to add_on_set_parameters_callback must return "
                    "SetParametersResult(successful=True), of rcl_interfaces.msg; it returns something else, or nothing"
                )
            elif "Wrong parameter type" in each["reason"]:
                said += f". The type of a parameter is that of its first value: {_declaration(each)} in __init__"
        elif nodes and each["node"] not in nodes:
            said = (
                f"found no node of that name; yours is {nodes[0]}: the name is the argument of Node's __init__, "
                f"super().__init__({each['node'].rpartition('/')[2]!r})"
            )
        else:
            said = "had no answer: a node answers only while it spins, and not while one of its callbacks waits"
            said += _sleep(facts)
        return shown(f"{command} {said}.", 500)
    return ""


def _sleep(facts: dict[str, Any]) -> str:
    """Say which line sleeps in a callback, if a slip in the file is that; empty if none is."""
    found = (each for each in facts.get("slips", []) if "sleep" in each["said"] and "callback" in each["said"])
    return next((f": line {each['line']}: {each['said']}" for each in found), "")


def _refusal(facts: dict[str, Any]) -> str:
    """Say which line refuses a new value, if a slip in the file is that; empty if none is."""
    found = (each for each in facts.get("slips", []) if "SetParametersResult" in each["said"])
    return next((f": line {each['line']}: {each['said']}" for each in found), "")


def _declaration(fact: dict[str, Any]) -> str:
    return f"self.declare_parameter({fact['name']!r}, {fact['value']!r})"
