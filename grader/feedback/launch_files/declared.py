"""The arguments that a launch file declares, and configurations with a default that nothing declares."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from gz_course.grader.feedback.launch_files import launch_fact
from gz_course.grader.feedback.launch_files.reading import LaunchFile, argument, text


@launch_fact("declared", most=None)
def declared(file: LaunchFile) -> Iterator[dict[str, Any]]:
    """Yield `line`, `name` and `default`, a text or empty."""
    names = set()
    for call in file.calls("DeclareLaunchArgument"):
        name = text(argument(call, "name", 0))
        names.add(name)
        yield {"line": call.lineno, "name": name, "default": text(file.value(argument(call, "default_value")))}
    for call in file.calls("LaunchConfiguration"):
        name = text(argument(call, "variable_name", 0))
        if argument(call, "default") and name not in names:
            yield {"line": call.lineno, "name": name, "default": text(file.value(argument(call, "default")))}
