"""Explanations for errors of a bridge's configuration whose own text does not say what was mistaken for what.

Source: the keys and values of ros_gz_bridge 1.0 (Jazzy), ros_gz_bridge/README.md.
"""

from __future__ import annotations

from gz_course.grader.feedback.errors import table
from gz_course.grader.feedback.rules import guarded

# Pattern of an error -> what is mistaken. {0} is the first group of the pattern.
MEANINGS = table(r"""
'(?:[^' ]*)([,;])' is |\S([,;]) is not a ROS message type|cannot become \S*([,;])(?:;|$)|must be .*, not \S*([,;])$
    the {0} at the end is taken for a part of the value: YAML needs nothing at the end of a line, which ends a value by
    itself
cannot become ((?:gz|ignition)::\S+::\w+)|conversion is known for ((?:gz|ignition)::\S+)
    {0} is the name of a class in C++; this file writes Gazebo's types with dots, gz.msgs.NAME
(\w+::(?:msg::)?\w+) is not a ROS message type
    {0} is the name of a class in C++; this file writes it with slashes, package/msg/Name
the direction '([\[\]@])' is none of
    {0} belongs to the topics on the command line of parameter_bridge; in this file, the direction is one of these words
expected a bridge .*found the text '([^']*@[^']*)'
    that is how a bridge is given on the command line; in this file, each of its parts has a key of its own
found the text '\w+ ?(=)
    between a key and its value stand a colon and a space in YAML, and no {0}
expected <block end>, but found '(?:\?|<block)[^;]*$
    a line is indented differently from those it belongs to: all keys of one entry begin in the same column
""")


@guarded("")
def bridge_meaning(error: str) -> str:
    """Return what is mistaken for what, given the text of an error; empty if it is unknown."""
    for pattern, words in MEANINGS:
        if match := pattern.search(error):
            return words.format(next((group for group in match.groups() if group), ""))
    return ""
