"""Drops lines from the output of ROS nodes that come from the middleware or do not matter."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from gz_course.sim.ros.launch_testing.tools import output


def get_rmw_output_filter(rmw_implementation: str, filter_type: str) -> list[str]:
    """Return the prefixes or patterns (`filter_type`) that a middleware has registered in the ament index."""
    from ament_index_python.resources import get_resource, has_resource

    if filter_type not in ("prefixes", "patterns"):
        raise TypeError(f"Unsupported filter_type '{filter_type}'. Supported types: ['prefixes', 'patterns']")
    name = f"rmw_output_{filter_type}"
    if not has_resource(name, rmw_implementation):
        return []
    return get_resource(name, rmw_implementation)[0].splitlines()


def basic_output_filter(
    filtered_prefixes: Iterable[str] | None = None,
    filtered_patterns: Iterable[str] | None = None,
    filtered_rmw_implementation: str | None = None,
) -> Callable[[str], str]:
    """Return a function that drops lines as that of `launch_testing.tools`, and those of a middleware."""
    prefixes = list(output.get_default_filtered_prefixes() if filtered_prefixes is None else filtered_prefixes)
    patterns = list(output.get_default_filtered_patterns() if filtered_patterns is None else filtered_patterns)
    if filtered_rmw_implementation:
        prefixes += get_rmw_output_filter(filtered_rmw_implementation, "prefixes")
        patterns += get_rmw_output_filter(filtered_rmw_implementation, "patterns")
    return output.basic_output_filter(prefixes, patterns)
