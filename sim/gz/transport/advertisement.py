"""A topic that a node of this process advertises, as the switchboard and the network know it."""

from __future__ import annotations

from dataclasses import dataclass

from gz_course.sim.gz.transport import naming
from gz_course.sim.gz.transport.options import UNTHROTTLED, Scope


@dataclass(eq=False, slots=True)
class Advertisement:
    """The public facts of a publisher. It does not refer to the publisher, which ends when nobody refers to it."""

    name: str
    """Fully qualified topic."""
    type_name: str
    node_uuid: str
    scope: Scope
    msgs_per_sec: int
    open: bool = True
    """False as soon as the publisher is closed or forgotten, before the tables know."""

    @property
    def throttled(self) -> bool:
        return self.msgs_per_sec != UNTHROTTLED

    @property
    def topic(self) -> str:
        """Return the topic without the partition."""
        return naming.split(self.name)[1]
