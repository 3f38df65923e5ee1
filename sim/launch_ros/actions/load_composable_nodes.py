"""The action that loads composable nodes, which is not available here."""

from gz_course.sim.launch_ros.actions.not_available import NotAvailable


class LoadComposableNodes(NotAvailable):
    """Loads composable nodes into a running container."""
