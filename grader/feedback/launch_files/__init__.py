"""Mistakes in launch files that raise no error, or one that does not name them.

The kind of submission that is a launch file records them as facts; the diagnosis names them if the run lost points.
"""

from __future__ import annotations

import ast
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from gz_course.grader.feedback.facts.syntax import Places, places_in
from gz_course.grader.feedback.launch_files import (
    actions,
    commands,
    creating,
    flags,
    namespaces,
    ros_arguments,
    unread,
    values,
    waiting,
)
from gz_course.grader.feedback.launch_files.commas import missing_commas
from gz_course.grader.feedback.launch_files.conditions import bridges, simulators
from gz_course.grader.feedback.launch_files.counts import fixed_counts
from gz_course.grader.feedback.launch_files.reading import LaunchFile, argument, text
from gz_course.grader.feedback.launch_files.remappings import remappings
from gz_course.grader.feedback.launch_files.sim_time import programs
from gz_course.grader.feedback.slips.language.late_binding import late_bound
from gz_course.grader.feedback.slips.language.no_effect import first_iteration
from gz_course.grader.feedback.slips.language.shared_objects import one_list_for_all
from gz_course.grader.feedback.slips.nodes.scan_callbacks import kept_defaults

MOST = 3  # places reported at most


def launch_places(content: bytes, nodes: Mapping[str, bytes] = MappingProxyType({})) -> dict[str, Places]:
    """Return the places in a launch file, none if it is not Python.

    `launch_slips` are mistakes: `line` and `said`, the words of a sentence. `fixed_worlds` are worlds that a command
    names as a text: `line` and `world`. `declared` are the arguments that the file declares, and the configurations
    with a default that nothing declares: `line`, `name` and `default` (a text, or empty). `remappings` are those of its
    nodes, as `remappings.py` says. `programs` are the Python programs that it starts, as `sim_time.py` says, and
    `simulators_made` and `bridges_made` the actions that start a simulator or a bridge, as `conditions.py` says.
    `fixed_counts` are loops that make so many actions at most, as `counts.py` says.
    `nodes` are the programs that come with the file, by name.
    """
    found: dict[str, Places] = {}

    def look(tree: ast.Module) -> Places:
        file = LaunchFile(tree)
        looks = (
            *values.LOOKS, *actions.LOOKS, *creating.LOOKS, *commands.LOOKS, *ros_arguments.LOOKS, *namespaces.LOOKS,
            *waiting.LOOKS, *flags.LOOKS,
        )  # fmt: skip
        slips = [place for look in looks for place in look(file)]
        slips += [*kept_defaults(tree), *first_iteration(tree), *namespaces.slashes_in_rules(file, nodes)]
        slips += namespaces.exchanged_rules(file, nodes)
        slips += ros_arguments.files_without_namespace(file, nodes)
        slips += [*ros_arguments.undeclared(file, nodes), *actions.events_that_never_come(file, nodes)]
        slips += [*late_bound(tree), *one_list_for_all(tree), *missing_commas(content)]
        slips += [*unread.undeclared_parameters(file, nodes)]
        slips += unread.for_another_program(file, nodes)
        slips += [place for look in unread.LOOKS for place in look(file)]
        found["launch_slips"] = [_place(*each) for each in dict(reversed(slips)).items()][::-1][:MOST]
        found["fixed_worlds"] = [{"line": line, "world": world} for line, world in values.fixed_worlds(file)][:MOST]
        found["declared"] = [
            {
                "line": call.lineno,
                "name": text(argument(call, "name", 0)),
                "default": text(file.value(argument(call, "default_value"))),
            }
            for call in file.calls("DeclareLaunchArgument")
        ]
        names = {place["name"] for place in found["declared"]}
        found["declared"] += [
            {"line": call.lineno, "name": name, "default": text(file.value(argument(call, "default")))}
            for call in file.calls("LaunchConfiguration")
            if argument(call, "default") and (name := text(argument(call, "variable_name", 0))) not in names
        ]
        found["remappings"] = list(remappings(file))[: 2 * MOST]
        found["programs"] = list(programs(file))[: 2 * MOST]
        found["bridges_made"] = list(bridges(file))[: 2 * MOST]
        found["fixed_counts"] = list(fixed_counts(file))[: 2 * MOST]
        found["simulators_made"] = list(simulators(file))[: 2 * MOST]
        return []

    places_in(content, look)
    return found


def _place(line: int, said: str) -> dict[str, Any]:
    return {"line": line, "said": said}
