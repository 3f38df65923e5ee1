"""Remappings as lists of substitutions."""

from __future__ import annotations

from collections.abc import Iterable

from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions
from gz_course.sim.ros.launch_ros.remap_rule_type import RemapRule, RemapRules, SomeRemapRule


def normalize_remap_rule(remap_rule: SomeRemapRule) -> RemapRule:
    """Return a pair of names, each a list of substitutions. Raises TypeError if it is no pair."""
    if not isinstance(remap_rule, tuple | list) or len(remap_rule) != 2:
        raise TypeError(f'the remapping {remap_rule!r} is no pair; ("/from", "/to") is expected')
    return normalize_to_list_of_substitutions(remap_rule[0]), normalize_to_list_of_substitutions(remap_rule[1])


def normalize_remap_rules(remap_rules: Iterable[SomeRemapRule]) -> RemapRules:
    return [normalize_remap_rule(each) for each in remap_rules]
