"""Places that are wrong in most programs that misunderstand angles, headings, gyroscopes, rays, goals or drives.

Each suspect says what it is about. A check that has seen the symptom in the recording names the suspect of that kind
(`grader/feedback/recorded/suspects.py`); without a symptom nobody hears of it.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Places, places_in
from gz_course.grader.feedback.suspects.actions import (
    answers,
    arrivals,
    goal_flags,
    goals,
    judgements,
    patrols,
    phases,
    rare_feedback,
    tried_goals,
    visits,
    waypoint_loops,
)
from gz_course.grader.feedback.suspects.memory import (
    ages,
    aliases,
    every_nth,
    flags,
    hidden_errors,
    lookups,
    old_values,
    oldest,
)
from gz_course.grader.feedback.suspects.planning import (
    aims,
    closed_gates,
    forgetting,
    frontiers,
    heaps,
    kept_ways,
    made_cells,
    margins,
    own_places,
    straight_goals,
    thresholds,
    way_ends,
    ways,
)
from gz_course.grader.feedback.suspects.sensing import (
    bearings,
    bias_use,
    bias_while_turning,
    exchanged_axes,
    farthest,
    gyroscopes,
    known_places,
    nearest_searches,
    pictures,
    ray_parts,
    rays,
    same_places,
    turned_angles,
)
from gz_course.grader.feedback.suspects.steering import (
    beyond_limits,
    drives,
    error_arithmetic,
    feedback,
    followers,
    heading_formulas,
    headings,
    made_poses,
    sleeps,
    smoothing,
    speed_limits,
    stale_parameters,
    standstills,
    steering_units,
    stopping_flags,
    turning_signs,
)

LOOKS = (
    *headings.LOOKS,
    *heading_formulas.LOOKS,
    *bias_while_turning.LOOKS,
    *gyroscopes.LOOKS,
    *bias_use.LOOKS,
    *rays.LOOKS,
    *known_places.LOOKS,
    *same_places.LOOKS,
    *patrols.LOOKS,
    *pictures.LOOKS,
    *aliases.LOOKS,
    *bearings.LOOKS,
    *feedback.LOOKS,
    *followers.LOOKS,
    *stopping_flags.LOOKS,
    *smoothing.LOOKS,
    *stale_parameters.LOOKS,
    *steering_units.LOOKS,
    *farthest.LOOKS,
    *goals.LOOKS,
    *goal_flags.LOOKS,
    *judgements.LOOKS,
    *tried_goals.LOOKS,
    *answers.LOOKS,
    *arrivals.LOOKS,
    *rare_feedback.LOOKS,
    *phases.LOOKS,
    *old_values.LOOKS,
    *drives.LOOKS,
    *hidden_errors.LOOKS,
    *ways.LOOKS,
    *visits.LOOKS,
    *waypoint_loops.LOOKS,
    *ages.LOOKS,
    *every_nth.LOOKS,
    *lookups.LOOKS,
    *oldest.LOOKS,
    *sleeps.LOOKS,
    *forgetting.LOOKS,
    *straight_goals.LOOKS,
    *speed_limits.LOOKS,
    *beyond_limits.LOOKS,
    *nearest_searches.LOOKS,
    *flags.LOOKS,
    *ray_parts.LOOKS,
    *way_ends.LOOKS,
    *heaps.LOOKS,
    *thresholds.LOOKS,
    *aims.LOOKS,
    *made_cells.LOOKS,
    *turning_signs.LOOKS,
    *closed_gates.LOOKS,
    *margins.LOOKS,
    *own_places.LOOKS,
    *made_poses.LOOKS,
    *standstills.LOOKS,
    *error_arithmetic.LOOKS,
    *exchanged_axes.LOOKS,
    *turned_angles.LOOKS,
    *frontiers.LOOKS,
    *kept_ways.LOOKS,
)
MOST = 20  # suspects kept


def suspects(content: bytes) -> Places:
    """Return `line`, `about` and `said`, the words of a sentence, of each suspect; nothing if it is not Python."""
    return places_in(content, _places)


def _places(tree: ast.Module) -> Places:
    found = list(dict.fromkeys(_all(tree)))
    return [{"line": line, "about": about, "said": said} for line, about, said in found[:MOST]]


def _all(tree: ast.Module) -> Iterator[tuple[int, str, str]]:
    for look in LOOKS:
        yield from look(tree)
