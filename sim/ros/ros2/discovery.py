"""Fast discovery of every DDS participant of this machine.

`graph.Graph` asks here whether all participants are known. Each participant of a domain holds a UDP port whose number
follows from the domain, so the system's table of ports tells how many there are. A participant announces itself to
every newcomer: Fast DDS does so at once, possibly before the newcomer listens, and then only in its next periodic
announcement 3 [s] later. Therefore the announcement of a non-existing participant (a scout) with this process's address
is sent to each port. All participants then announce themselves again to this process, and forget the scout, because its
farewell follows in the next packet.

Source: OMG DDSI-RTPS 2.2, https://www.omg.org/spec/DDSI-RTPS/2.2, sections 8.5.3, 9.4.5, 9.6.1 and 9.6.2
"""

from __future__ import annotations

import contextlib
import secrets
import socket
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from gz_course.sim import machine_clock

SCOUT_EVERY = 0.25  # [s] between scouts while a participant is missing
_PORT_TABLE = Path("/proc/net/udp")
_OWN_FILES = Path("/proc/self/fd")
_FIRST_PORT, _PORTS_PER_DOMAIN, _PORTS_PER_PARTICIPANT, _PARTICIPANTS = 7410, 250, 2, 120
_EVERY_ROS_PARTICIPANT = "ros_discovery_info"  # the topic on which each ROS participant publishes its nodes
_PREFIX, _HOST = 12, 4  # bytes of a GUID that identify the participant, and its vendor and host


class Participants:
    """The participants of one domain on this machine, as seen by one node.

    Created before the node, so that the node's port is the one this process opens afterwards; `attach` sets the node.
    """

    def __init__(self, domain: int) -> None:
        self._node: Any = None
        self._others_of_this_process = set(_own_sockets())
        first = _FIRST_PORT + _PORTS_PER_DOMAIN * domain
        self._range = range(first, first + _PORTS_PER_PARTICIPANT * _PARTICIPANTS, _PORTS_PER_PARTICIPANT)
        self._next_scout = 0.0
        self._own_prefix = b""

    def attach(self, node: Any) -> None:
        """Set the node, made after this object."""
        self._node = node

    def all_known(self) -> bool | None:
        """Return whether the node knows all participants, None if that is unknown; send scouts while some are
        missing.
        """
        ports = self._ports()
        own = self._own_port(ports)
        if own is None:
            return None
        if len(self._known()) >= len(ports):
            return True
        if machine_clock.now() >= self._next_scout:
            self._next_scout = machine_clock.now() + SCOUT_EVERY
            _send_scout(own, [port for port in ports if port != own], self._own_prefix[:_HOST])
        return False

    def _ports(self) -> dict[int, str]:
        """Return the sockets (inodes) of the domain's participants by port; empty if the system does not list them."""
        try:
            lines = _PORT_TABLE.read_text(encoding="ascii").splitlines()[1:]
        except OSError:
            return {}
        fields = (line.split() for line in lines)
        sockets = {int(field[1].rpartition(":")[2], 16): field[9] for field in fields if len(field) > 9}
        return {port: inode for port, inode in sockets.items() if port in self._range}

    def _own_port(self, ports: dict[int, str]) -> int | None:
        own = set(_own_sockets()) - self._others_of_this_process
        return next((port for port, inode in ports.items() if inode in own), None)

    def _known(self) -> set[bytes]:
        """Return the participants of this host that the node knows, including its own."""
        ends = self._node.get_publishers_info_by_topic(_EVERY_ROS_PARTICIPANT, no_mangle=True)
        prefixes = {bytes(end.endpoint_gid)[:_PREFIX] for end in ends}
        if not self._own_prefix:
            for end in self._node.get_publishers_info_by_topic("/parameter_events"):
                if end.node_name == self._node.get_name():
                    self._own_prefix = bytes(end.endpoint_gid)[:_PREFIX]
        return {prefix for prefix in prefixes if prefix[:_HOST] == self._own_prefix[:_HOST]}


def _own_sockets() -> Iterator[str]:
    for file in _OWN_FILES.iterdir():
        with contextlib.suppress(OSError):  # closed in the meantime
            target = str(file.readlink())
            if target.startswith("socket:["):
                yield target[8:-1]


def _send_scout(reply_port: int, ports: list[int], host: bytes) -> None:
    """Announce a participant that listens on `reply_port` of this machine to these ports, then its farewell."""
    prefix = host.ljust(_HOST, b"\0") + secrets.token_bytes(_PREFIX - _HOST)
    with contextlib.suppress(OSError), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for packet in (announcement(prefix, reply_port), farewell(prefix)):
            for port in ports:
                sender.sendto(packet, ("127.0.0.1", port))


def announcement(prefix: bytes, port: int) -> bytes:
    """Return the RTPS packet that announces a participant (12 bytes `prefix`) on 127.0.0.1:`port`."""
    locator = struct.pack("<iI12x4B", 1, port, 127, 0, 0, 1)
    parameters = [
        (0x15, bytes([2, 2, 0, 0])),  # protocol version
        (0x16, bytes(4)),  # vendor: none
        (0x50, _guid(prefix)),
        (0x32, locator),  # address for replies: metatraffic
        (0x31, locator),
        (0x02, struct.pack("<iI", 1, 0)),  # lease duration: 1 s
        (0x58, struct.pack("<I", 0b11)),  # endpoints: announcer and detector of participants
    ]
    return _packet(prefix, number=1, flags=0x05, inline=b"", payload=_list(parameters))


def farewell(prefix: bytes) -> bytes:
    """Return the RTPS packet that announces the end of a participant."""
    disposed_and_unregistered = bytes([0, 0, 0, 0b11])
    inline = _list([(0x70, _guid(prefix)), (0x71, disposed_and_unregistered)])
    return _packet(prefix, number=2, flags=0x0B, inline=inline, payload=_list([(0x50, _guid(prefix))]))


def _guid(prefix: bytes) -> bytes:
    return prefix + bytes([0, 0, 1, 0xC1])


def _list(parameters: list[tuple[int, bytes]]) -> bytes:
    end = struct.pack("<HH", 1, 0)
    return b"".join(struct.pack("<HH", name, len(value)) + value for name, value in parameters) + end


def _packet(prefix: bytes, number: int, flags: int, inline: bytes, payload: bytes) -> bytes:
    """Return a packet of one DATA submessage, little endian, from the participant's announcer to every detector."""
    header = b"RTPS" + bytes([2, 2, 0, 0]) + prefix
    ends = bytes([0, 1, 0, 0xC7, 0, 1, 0, 0xC2])
    data = struct.pack("<HH", 0, 16) + ends + struct.pack("<iI", 0, number) + inline + bytes([0, 3, 0, 0]) + payload
    return header + struct.pack("<BBH", 0x15, flags, len(data)) + data
