"""The action that starts a container of composable nodes, which is not available here."""

from gz_course.sim.launch_ros.actions.not_available import NotAvailable


class ComposableNodeContainer(NotAvailable):
    """A process for composable nodes."""
