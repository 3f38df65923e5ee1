"""The datagrams of discovery: a little-endian length of two bytes, then a gz.msgs.Discovery.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/include/gz/transport/Discovery.hh
Source: https://github.com/gazebosim/gz-msgs/blob/gz-msgs10/proto/gz/msgs/discovery.proto
"""

from __future__ import annotations

from google.protobuf.message import DecodeError

from gz_course.sim.gz.msgs.discovery_pb2 import Discovery

WIRE_VERSION = 10
"""The protocol version of gz-transport 11 to 15."""
STATISTICS_VERSION = 110
"""The version of processes that send statistics of topics."""
MAX_DATAGRAM_BYTES = 65535
_LENGTH_BYTES = 2


def encode(message: Discovery) -> bytes:
    """Return the datagram of a message. Raises ValueError if it would be longer than 65535 bytes."""
    body = message.SerializeToString()
    size = len(body) + _LENGTH_BYTES
    if size > MAX_DATAGRAM_BYTES:
        raise ValueError(
            f"A discovery message of {size} bytes does not fit in a datagram ({MAX_DATAGRAM_BYTES} bytes): "
            "the topic name is too long."
        )
    return len(body).to_bytes(_LENGTH_BYTES, "little") + body


def decode(data: bytes, version: int = WIRE_VERSION) -> Discovery | None:
    """Return the message in a datagram, or None if the datagram is not one of this protocol and version."""
    if len(data) < _LENGTH_BYTES or int.from_bytes(data[:_LENGTH_BYTES], "little") != len(data) - _LENGTH_BYTES:
        return None
    try:
        message = Discovery.FromString(data[_LENGTH_BYTES:])
    except DecodeError:
        return None
    if message.version != version or not message.process_uuid:
        return None
    return message
