"""Suspects in lookups of tf2 whose two frames are exchanged (`exchanged_frames`)."""

from __future__ import annotations

import ast

from gz_course.grader.feedback.facts.syntax import Words, assigned, calls, unparse
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About


@suspicion_of(About.EXCHANGED_FRAMES)
def exchanged(tree: ast.AST) -> Words:
    """Find a lookup whose target is the frame of a message, and whose source is not."""
    frames = {unparse(target) for target, value in assigned(tree) if unparse(value).endswith("header.frame_id")}
    for call, name in calls(tree):
        given = {each.arg: each.value for each in call.keywords} | dict(
            zip(("target_frame", "source_frame"), call.args, strict=False)
        )
        if name != "lookup_transform" or not {"target_frame", "source_frame"} <= given.keys():
            continue
        target, source = (unparse(given[each]) for each in ("target_frame", "source_frame"))
        of_a_message = [each in frames or each.endswith("header.frame_id") for each in (target, source)]
        if of_a_message == [True, False]:
            yield (
                call,
                f"lookup_transform({target}, {source}, ...): the frame into which points are taken comes first, that "
                "of the message second; here they are exchanged, which gives the inverse",
            )
