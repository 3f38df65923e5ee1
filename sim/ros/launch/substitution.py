"""Text that is known only when the launch file runs; the base class of everything in `launch.substitutions`.

Actions store arguments as lists of substitutions (`launch.utilities.normalize_to_list_of_substitutions`) and turn them
into text when they are executed (`launch.utilities.perform_substitutions`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.launch_context import LaunchContext


class Substitution:
    """Text that `perform` computes; subclasses override `perform` and `describe`."""

    def perform(self, context: LaunchContext) -> str:
        """Return the text. Raises SubstitutionFailure, or another LaunchError."""
        raise NotImplementedError(f"{type(self).__name__} does not say how it is performed")

    def describe(self) -> str:
        """Return a short form for `ros2 launch --show-args` and `--print`."""
        return repr(self)
