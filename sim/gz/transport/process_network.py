"""The one network of this process: made when it is first needed, left at exit, and given up by a forked child."""

from __future__ import annotations

import atexit
import os
import threading

from gz_course.sim.gz.transport.environment import DEFAULT_IP, NetworkSettings, complain
from gz_course.sim.gz.transport.network import Network

_network: Network | None = None
_inherited: list[Network] = []
_creation = threading.Lock()


def joined() -> Network:
    """Return the network of this process, created by the first call.

    Raises OSError if not even 127.0.0.1 can be used.
    """
    return _network or _create()


def present() -> Network | None:
    """Return the network of this process, or None if it has joined none."""
    return _network


def _create() -> Network:
    global _network
    with _creation:
        if _network is None:
            settings = NetworkSettings.from_environment()
            try:
                _network = Network(settings)
            except OSError as error:
                if settings.ip == DEFAULT_IP:
                    raise
                complain(
                    f"{error}. Did you set the environment variable GZ_IP to an address of this machine? "
                    f"{DEFAULT_IP} is used instead of {settings.ip}."
                )
                fallback = NetworkSettings(**{**vars(settings), "ip": DEFAULT_IP})
                _network = Network(fallback)
            atexit.register(_network.close)
        return _network


def _abandon_in_child() -> None:
    global _network, _creation
    _creation = threading.Lock()
    if _network is not None:
        atexit.unregister(_network.close)
        _network.abandon_after_fork()
        _inherited.append(_network)  # kept, because closing the parent's ZeroMQ sockets here would disturb the parent
        _network = None


os.register_at_fork(
    before=lambda: _creation.acquire(),
    after_in_parent=lambda: _creation.release(),
    after_in_child=_abandon_in_child,
)
