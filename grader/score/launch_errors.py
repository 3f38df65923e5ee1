"""Explanations for errors of launch files and of xacro whose own text does not say what to change.

Source: the error texts of `launch` 3.4, `launch_ros` 0.26 and `xacro` 2.1, which are those of ROS 2 Jazzy.
"""

from __future__ import annotations

import re

# Pattern of an error -> what to change. {0} is the first group of the pattern.
MEANINGS = (
    (
        re.compile(r"missing required argument '([^']+)'"),
        "an argument without default_value must be given in every call: DeclareLaunchArgument('{0}', "
        "default_value='...')",
    ),
    (
        re.compile(r"launch configuration '([^']+)' does not exist"),
        "no action before this one declares {0}: it needs a DeclareLaunchArgument of the same name, above what uses it",
    ),
    (
        re.compile(r"Unknown substitution command \[(\w+)"),
        "in xacro, $(...) calls a command; the value of a property is written in braces, ${{{0}}}",
    ),
    (
        re.compile(r"(?:xacro.*|^)name '(\w+)' is not defined", re.DOTALL),
        "no xacro:property above, and no parameter of this macro, is called {0}",
    ),
    (
        re.compile(r"unknown macro name: (?:xacro:)?(\w+)"),
        "no xacro:macro above is called {0}",
    ),
    (
        re.compile(r"(?:unbound prefix|Undeclared namespace prefix)"),
        'the root of the file lacks the name of xacro: <robot xmlns:xacro="http://www.ros.org/wiki/xacro">',
    ),
    (
        re.compile(r"mismatched tag|not well-formed|no element found"),
        "the file is no valid XML: every tag that begins must end, <link ...> with </link>",
    ),
    (
        re.compile(r"No such file or directory: '(\w+ [^']*)'"),
        "the whole command line is one word of the list: cmd takes each word by itself, ['gz', 'sim', ...]",
    ),
)


def launch_meaning(error: str) -> str:
    """Return what to change, given the text of an error; empty if it is unknown."""
    for pattern, words in MEANINGS:
        if match := pattern.search(error):
            return words.format(*match.groups())
    return ""
