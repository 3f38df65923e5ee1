"""Mistakes of a first month with Python and rclpy that raise no error, or one that does not name them.

A kind of submission that is Python records these places as facts of a run. The diagnosis names them only if the run
lost points. Each file has its `LOOKS`: functions of a syntax tree that yield a line and the words of a sentence.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from types import MappingProxyType

from gz_course.grader.feedback.facts.syntax import Places, places_in
from gz_course.grader.feedback.slips.clocks import (
    exact_sums,
    mixed_clocks,
    no_time_passed,
    rates,
    stamp_parts,
    starts,
    time_units,
)
from gz_course.grader.feedback.slips.geometry import (
    angles,
    colours,
    euler_angles,
    filtered_rays,
    limited_values,
    limits,
    map_starts,
    rotations,
    searches,
    sorted_rays,
)
from gz_course.grader.feedback.slips.language import (
    conditions,
    everyday,
    keys,
    late_binding,
    locks,
    names,
    never_set,
    no_effect,
    none_tests,
    not_what_they_seem,
    one_array,
    own_calls,
    resets,
    results,
    sequences,
    shared_objects,
    states,
    unchanged_conditions,
    unreached,
    whole_arrays,
)
from gz_course.grader.feedback.slips.language.everyday import LONGEST_PERIOD, periods
from gz_course.grader.feedback.slips.nodes import (
    action_servers,
    callbacks,
    called_once,
    endless_spins,
    endless_waits,
    parameters,
    publishers,
    scan_callbacks,
    transforms,
    unused_callbacks,
    waiting,
    waiting_messages,
)
from gz_course.grader.feedback.slips.nodes.message_fields import unknown_fields

MOST = 3  # places reported at most
# What is said first of several.
ROOMS = (
    everyday.LOOKS, callbacks.LOOKS, unused_callbacks.LOOKS, called_once.LOOKS, late_binding.LOOKS, waiting.LOOKS,
    names.LOOKS, keys.LOOKS, never_set.LOOKS, unreached.LOOKS, time_units.LOOKS, stamp_parts.LOOKS, no_effect.LOOKS,
    parameters.LOOKS, action_servers.LOOKS, sequences.LOOKS, transforms.LOOKS, waiting_messages.LOOKS,
    searches.LOOKS, scan_callbacks.LOOKS, not_what_they_seem.LOOKS, angles.LOOKS, euler_angles.LOOKS,
    exact_sums.LOOKS, starts.LOOKS, sorted_rays.LOOKS, mixed_clocks.LOOKS, no_time_passed.LOOKS, rotations.LOOKS,
    limits.LOOKS, conditions.LOOKS, resets.LOOKS, results.LOOKS, states.LOOKS, publishers.LOOKS, endless_spins.LOOKS,
    rates.LOOKS, none_tests.LOOKS, one_array.LOOKS, shared_objects.LOOKS, endless_waits.LOOKS, own_calls.LOOKS,
    limited_values.LOOKS, locks.LOOKS, unchanged_conditions.LOOKS, filtered_rays.LOOKS, map_starts.LOOKS,
    colours.LOOKS, whole_arrays.LOOKS,
)  # fmt: skip


def slips(
    content: bytes,
    duration: float = LONGEST_PERIOD,
    fields: Mapping[str, list[str]] = MappingProxyType({}),
    names: Sequence[str] = (),
) -> Places:
    """Return `line` and `said`, the words of a sentence, of each such place; nothing if the file is not Python.

    `duration` [s] is the length of the run, `fields` are those of the messages of the exercise, by class;
    `names` those of the parameters that its trials give the node.
    """
    return places_in(content, lambda tree: _places(tree, duration, fields, names))


def _places(tree: ast.Module, duration: float, fields: Mapping[str, list[str]], names: Sequence[str]) -> Places:
    found = [*periods(tree, duration), *unknown_fields(tree, fields), *parameters.declared_otherwise(tree, names)]
    for room in ROOMS:
        found += [place for look in room for place in look(tree)]
    return [{"line": line, "said": said} for line, said in found[:MOST]]
