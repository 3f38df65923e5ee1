"""The processes heard on a discovery port, and how much of the tables each of them takes.

Anybody can send datagrams with invented processes and long names. So the tables have limits, and when one is reached,
the process that was not heard for the longest time makes room: first among those heard once only, then among those that
sent heartbeats. A real process is heard every second, so it comes back at once, and its connection lasts that long.
Used by the I/O thread only.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass

MOST_PROCESSES = 2000
MOST_BYTES, MOST_BYTES_OF_ONE = 8_000_000, 2_000_000
"""Size of all that the tables hold, and of what one process may have there."""
PROVEN_AFTER_S = 0.9
"""Time [s] between two messages, after which a process is not a passing one."""


@dataclass(slots=True)
class _Peer:
    first: float
    last: float
    size: int = 0


class Peers:
    """Processes by UUID; times are monotonic [s]."""

    def __init__(self) -> None:
        self._new: OrderedDict[str, _Peer] = OrderedDict()
        self._proven: OrderedDict[str, _Peer] = OrderedDict()
        self._size = 0

    def __len__(self) -> int:
        return len(self._new) + len(self._proven)

    def hear(self, process: str, now: float) -> str | None:
        """Record that a process was heard; return the process that must be forgotten for it, if one must."""
        peer = self._new.pop(process, None) or self._proven.pop(process, None)
        forgotten = None
        if peer is None:
            if len(self) >= MOST_PROCESSES:
                forgotten = self._oldest("")
            peer = _Peer(now, now)
        peer.last = now
        (self._proven if now - peer.first >= PROVEN_AFTER_S else self._new)[process] = peer
        return forgotten

    def has_room(self, process: str, size: int) -> bool:
        """Return whether a process may add something of this size [bytes] to what it has in the tables."""
        peer = self._new.get(process) or self._proven.get(process)
        return (peer.size if peer else 0) + size <= MOST_BYTES_OF_ONE

    def charge(self, process: str, size: int) -> None:
        """Record that what a process has in the tables grew by this size (shrank, if negative) [bytes]."""
        peer = self._new.get(process) or self._proven.get(process)
        if peer is not None:
            peer.size += size
            self._size += size

    def too_much(self, keep: str) -> str | None:
        """Return a process other than `keep` that must be forgotten because the tables are too large, if one must."""
        return self._oldest(keep) if self._size > MOST_BYTES else None

    def forget(self, process: str) -> None:
        peer = self._new.pop(process, None) or self._proven.pop(process, None)
        if peer is not None:
            self._size -= peer.size

    def silent(self, since: float) -> list[str]:
        """Return the processes that were last heard before `since`."""
        found = []
        for group in (self._new, self._proven):
            for process, peer in group.items():
                if peer.last >= since:
                    break
                found.append(process)
        return found

    def oldest_message(self) -> float | None:
        """Return when the process that is silent for the longest time was heard."""
        times = [next(iter(group.values())).last for group in (self._new, self._proven) if group]
        return min(times, default=None)

    def _oldest(self, keep: str) -> str | None:
        for group in (self._new, self._proven):
            for process in group:
                if process != keep:
                    return process
        return None
