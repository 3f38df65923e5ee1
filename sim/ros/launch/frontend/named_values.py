"""Children of an element that are pairs: `<env name= value=/>`, `<keep name= value=/>`."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from gz_course.sim.ros.launch.frontend.entity import Entity
    from gz_course.sim.ros.launch.frontend.parser import Parser
    from gz_course.sim.ros.launch.substitution import Substitution


def named_values(
    entities: Iterable[Entity], parser: Parser
) -> dict[tuple[Substitution, ...], list[Substitution]]:  # fmt: skip
    """Return the value of each name."""
    pairs = {}
    for each in entities:
        name = tuple(parser.parse_substitution(each.get_attr("name")))
        pairs[name] = parser.parse_substitution(each.get_attr("value"))
        each.assert_entity_completely_parsed()
    return pairs
