"""The action that starts a lifecycle node, which is not available here."""

from gz_course.sim.launch_ros.actions.not_available import NotAvailable


class LifecycleNode(NotAvailable):
    """A node whose states are changed from outside."""

    _instead = "use Node for a node that needs no state changes"
