"""Metadata of messages, publishers, subscribers and services.

Callbacks of subscribe_raw() get a MessageInfo; topic_info() lists MessagePublisher, service_info() ServicePublisher.
"""

from __future__ import annotations

from dataclasses import dataclass

from gz_course.sim.gz.transport.options import UNTHROTTLED, AdvertiseMessageOptions, AdvertiseServiceOptions, Scope


@dataclass(frozen=True, slots=True)
class MessageInfo:
    """The origin of a message."""

    topic: str
    """Topic name without the partition, e.g. `/cmd_vel`."""
    type: str
    """Type name as sent, e.g. `gz.msgs.Twist`."""
    partition: str
    """Partition without a leading slash."""
    intra_process: bool
    """True if the publisher is in this process."""


@dataclass(frozen=True, slots=True)
class MessagePublisher:
    """One publisher of a topic, or, in the list of subscribers, one subscriber."""

    topic: str
    """Topic name without the partition."""
    addr: str
    """Address of the process, e.g. `tcp://127.0.0.1:37011`; empty if other processes cannot reach it."""
    msg_type_name: str
    """Type name; `google.protobuf.Message` for a subscriber to messages of any type."""
    p_uuid: str
    """UUID of the process."""
    n_uuid: str
    """UUID of the node."""
    scope: Scope = Scope.ALL
    """Processes and machines that it reaches."""
    msgs_per_sec: int = UNTHROTTLED
    """Maximum number of messages sent per second."""
    ctrl: str = ""
    """Not used in this version of the protocol."""

    @property
    def options(self) -> AdvertiseMessageOptions:
        """Return the advertised options, as far as other processes know them."""
        return AdvertiseMessageOptions(self.scope, self.msgs_per_sec)


@dataclass(frozen=True, slots=True)
class ServicePublisher:
    """One provider of a service."""

    topic: str
    """Name of the service without the partition."""
    addr: str
    """Address of the process, e.g. `tcp://127.0.0.1:37011`; empty if other processes cannot reach it."""
    req_type_name: str
    """Type name of requests."""
    rep_type_name: str
    """Type name of responses; `gz.msgs.Empty` for a one-way service."""
    p_uuid: str
    """UUID of the process."""
    n_uuid: str
    """UUID of the node."""
    scope: Scope = Scope.ALL
    """Processes and machines that it reaches."""
    socket_id: str = ""
    """Routing id of the socket at `addr`."""

    @property
    def options(self) -> AdvertiseServiceOptions:
        """Return the advertised options, as far as other processes know them."""
        return AdvertiseServiceOptions(self.scope)
