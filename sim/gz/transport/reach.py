"""The network that a scope requires; it is joined when it is first needed."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING

from gz_course.sim.gz.transport.options import Scope

if TYPE_CHECKING:
    from gz_course.sim.gz.transport.network import Network


def network_for(scope: Scope) -> Network | None:
    """Return the network of this process; None for `Scope.PROCESS`, which opens no socket."""
    if scope == Scope.PROCESS:
        return None
    from gz_course.sim.gz.transport import process_network

    return process_network.joined()


def present_network_for(scope: Scope) -> Network | None:
    """Return the network of this process if it has joined one already and the scope requires it."""
    if scope == Scope.PROCESS:
        return None
    from gz_course.sim.gz.transport import process_network

    return process_network.present()


def sending_together() -> contextlib.AbstractContextManager[None]:
    """Return a context at whose end the messages of this process to others leave together, which costs much less."""
    network = present_network_for(Scope.ALL)
    return contextlib.nullcontext() if network is None else network.sending_together()
