"""Suspects in stops that nothing ends: whatever is near on any side stops the robot, and it does not turn."""

from __future__ import annotations

import ast
import re

from gz_course.grader.feedback.facts.syntax import Words, assigned, called, nodes_of, unparse, walk
from gz_course.grader.feedback.suspects import suspicion_of
from gz_course.grader.feedback.suspects.about import About

NEAREST = re.compile(r"\b(?:min|nanmin|amin)\((?:\w+\.)*ranges\)|\.ranges\)?\.min\(\)|\bmin\(\w+(?:\.\w+)*\.ranges\)")


@suspicion_of(About.STANDSTILL)
def stops_for_all_sides(tree: ast.AST) -> Words:
    """Find `if min(scan.ranges) < 0.5: command.linear.x = 0.0`, where the test is true for what is behind, too."""
    nearest = {unparse(one) for one, value in assigned(tree) if NEAREST.search(unparse(value))}
    for node in nodes_of(tree, ast.If):
        test = unparse(node.test)
        parts = {unparse(each) for each in walk(node.test)}
        if " < " not in test or not (NEAREST.search(test) or parts & nearest):
            continue
        body = ast.Module(body=node.body, type_ignores=[])
        given = {unparse(one): unparse(value) for one, value in assigned(body)}
        stops = any(one.endswith("linear.x") and value in ("0", "0.0") for one, value in given.items())
        if (stops or "Twist()" in unparse(body)) and not any(one.endswith("angular.z") for one in given):
            more = "" if called(body) - {"Twist", "publish"} else ", and as long as it stands nothing changes"
            yield (
                node,
                f"`if {test[:60]}` stops the robot for whatever is near on any side, also behind it{more}: look at the "
                "rays ahead only, and turn",
            )
