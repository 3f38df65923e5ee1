"""The place of this process among the others: what reaches beyond the process goes through here."""

from __future__ import annotations

import uuid
from typing import TYPE_CHECKING

from gz.transport.message_info import MessagePublisher

if TYPE_CHECKING:
    from gz.transport.publisher import Publisher
    from gz.transport.subscription import Subscription


class Network:
    """Knows this process only."""

    def __init__(self) -> None:
        self.process_uuid = str(uuid.uuid4())
        self.address = ""

    def send(self, name: bytes, data: bytes, type_name: str) -> None:
        """Sends to other processes."""

    def advertise(self, publisher: Publisher) -> None:
        """Announces a publisher."""

    def unadvertise(self, publisher: Publisher) -> None:
        """Announces its end."""

    def subscribe(self, subscription: Subscription) -> None:
        """Looks for publishers."""

    def unsubscribe(self, subscription: Subscription) -> None:
        """Announces the end of a subscription."""

    def listening_processes(self, name: str, type_name: str) -> int:
        """How many other processes listen."""
        return 0

    def known_elsewhere(self) -> tuple[list[tuple[str, MessagePublisher]], list[tuple[str, MessagePublisher]]]:
        """What other processes have."""
        return [], []


_NETWORK = Network()


def joined() -> Network:
    """The network of this process."""
    return _NETWORK
