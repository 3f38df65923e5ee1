"""The names that launch files in XML and YAML have for actions and substitutions.

    @expose_action("executable")
    class ExecuteProcess(Action):
        @classmethod
        def parse(cls, entity, parser): ...

`parse` returns the class, or a function, and the keyword arguments to call it with.

Source: ros2/launch, launch/launch/frontend/expose.py
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend.entity import Entity
    from gz_course.sim.ros.launch.frontend.parser import Parser
    from gz_course.sim.ros.launch.substitution import Substitution

Made = TypeVar("Made")
Arguments = Sequence[list["Substitution"]]
Maker = Callable[[Arguments], "Substitution"]
action_parse_methods: dict[str, Callable[[Entity, Parser], tuple[Callable[..., Any], dict[str, Any]]]] = {}
substitution_parse_methods: dict[str, tuple[int, float, Maker]] = {}


def expose_action(name: str) -> Callable[[Made], Made]:
    """Register the decorated class, which has a class method `parse(entity, parser)`, or that function itself."""

    def expose(exposed: Made) -> Made:
        parse: Any = exposed
        action_parse_methods[name] = getattr(exposed, "parse", parse)
        return exposed

    return expose


def expose_substitution(name: str) -> Callable[[Made], Made]:
    """Register the decorated class as `$(name argument ...)`; its class method `parse` gets the arguments."""

    def expose(exposed: Made) -> Made:
        function: Any = exposed
        parse = getattr(exposed, "parse", function)

        def make(arguments: Arguments) -> Substitution:
            kind, options = parse(arguments)
            return kind(**options)

        substitution_parse_methods[name] = (0, float("inf"), make)
        return exposed

    return expose


def add_substitution(name: str, at_least: int, at_most: float, make: Callable[..., Substitution]) -> None:
    """Register `$(name ...)` as `make(...)`, called with `at_least` to `at_most` lists of substitutions."""
    substitution_parse_methods[name] = (at_least, at_most, lambda arguments: make(*arguments))
