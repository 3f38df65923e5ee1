"""A launch description as a tree, for `ros2 launch --print`."""

from __future__ import annotations

from collections.abc import Iterable

from gz_course.sim.ros.launch.actions import IncludeLaunchDescription
from gz_course.sim.ros.launch.launch_description import LaunchDescription
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity


class LaunchIntrospector:
    """Formats launch descriptions as indented text."""

    def format_launch_description(self, launch_description: LaunchDescription) -> str:
        name = repr(launch_description).replace("gz_course.sim.ros.launch", "launch")  # as its public name is
        return "\n".join([name, *_tree(launch_description.entities, ())])


def _tree(entities: Iterable[LaunchDescriptionEntity], chain: tuple[IncludeLaunchDescription, ...]) -> list[str]:
    lines = []
    items = list(entities)
    for number, entity in enumerate(items):
        last = number == len(items) - 1
        lines.append(("└── " if last else "├── ") + entity.describe())
        lines += [("    " if last else "│   ") + line for line in _below(entity, chain)]
    return lines


def _below(entity: LaunchDescriptionEntity, chain: tuple[IncludeLaunchDescription, ...]) -> list[str]:
    if isinstance(entity, IncludeLaunchDescription):
        if entity.leads_back_into(chain):
            return ["└── (itself again)"]
        chain = (*chain, entity)
    lines = _tree(entity.describe_sub_entities(), chain)
    for text, group in entity.describe_conditional_sub_entities():
        below = _tree(group, chain)
        if below:
            lines += [f"└── {text}", *[f"    {line}" for line in below]]
    return lines


def arguments_text(description: LaunchDescription) -> str:
    """Return the arguments of a launch description with their descriptions and defaults, as `--show-args` prints."""
    lines = ["Arguments (pass arguments as '<name>:=<value>'):"]
    arguments = description.get_launch_arguments()
    for argument in arguments:
        mark = "*" if argument._conditionally_included else ""
        lines.append(f"\n    '{argument.name}':{mark}\n        {argument.description}")
        if argument.default_value is not None:
            default = " + ".join(part.describe() for part in argument.default_value)
            lines.append(f"        (default: {default})")
    if not arguments:
        lines.append("\n  No arguments.")
    if any(argument._conditionally_included for argument in arguments):
        lines.append("\n* argument(s) which are only used if specific conditions occur")
    return "\n".join(lines)
