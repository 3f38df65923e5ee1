"""Discovery by a new participant: packets, the table of ports, and real participants."""

import argparse
import os
import socket
import struct
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.run.fair_clock import FairClock
from gz_course.sim.ros.ros2 import discovery, graph
from gz_course.sim.ros.ros2.discovery import Participants, announcement, farewell
from gz_course.sim.ros.ros2.graph import Graph

ROUNDS = 6
PREFIXES = st.binary(min_size=12, max_size=12)


def parameters(data):
    """Return the values of a parameter list by identifier, and the remaining bytes."""
    found = {}
    while True:
        identifier, length = struct.unpack_from("<HH", data)
        if identifier == 1:
            return found, data[4:]
        found[identifier] = data[4 : 4 + length]
        data = data[4 + length :]


def submessage(packet, prefix):
    """Return (flags, sequence number, data after the fixed part) of the single DATA submessage of a packet."""
    assert packet[:8] == b"RTPS\x02\x02\0\0"
    assert packet[8:20] == prefix
    kind, flags, length = struct.unpack_from("<BBH", packet, 20)
    assert (kind, length) == (0x15, len(packet) - 24)
    assert struct.unpack_from("<HH", packet, 24) == (0, 16), "inline QoS would follow the sequence number"
    assert packet[28:36] == bytes([0, 1, 0, 0xC7, 0, 1, 0, 0xC2])
    return flags, struct.unpack_from("<iI", packet, 36), packet[44:]


@given(PREFIXES, st.integers(1, 65535))
def test_an_announcement_says_who_and_where(prefix, port):
    flags, number, data = submessage(announcement(prefix, port), prefix)
    assert (flags, number) == (0b0101, (0, 1)), "little endian, with data"
    assert data[:4] == bytes([0, 3, 0, 0])
    found, rest = parameters(data[4:])
    assert rest == b""
    assert found[0x50] == prefix + bytes([0, 0, 1, 0xC1])
    kind, where, address = struct.unpack("<iI16s", found[0x32])
    assert (kind, where, address) == (1, port, bytes(12) + bytes([127, 0, 0, 1]))
    assert struct.unpack("<iI", found[2]) == (1, 0), "it is forgotten after a second should the farewell be lost"


@given(PREFIXES)
def test_a_farewell_is_of_the_same_participant(prefix):
    flags, number, data = submessage(farewell(prefix), prefix)
    assert (flags, number) == (0b1011, (0, 2)), "little endian, with inline QoS and a key"
    inline, rest = parameters(data)
    assert inline == {0x70: prefix + bytes([0, 0, 1, 0xC1]), 0x71: bytes([0, 0, 0, 3])}
    key, rest = parameters(rest[4:])
    assert (key, rest) == ({0x50: prefix + bytes([0, 0, 1, 0xC1])}, b"")


OPTIONS = argparse.Namespace(spin_time=None, use_sim_time=False)


def seconds_until_complete():
    """Return the nodes that a new node knows when it has settled, and after how long [s]: of the wall, and fairly.

    The fair clock stands still while this process waits for a processor.
    """
    clock = FairClock(lambda: [os.getpid()])
    started, fairly = time.monotonic(), clock.now()
    with Graph(OPTIONS) as newcomer:
        newcomer.settle()
        return newcomer.nodes(), time.monotonic() - started, clock.now() - fairly


def test_a_newcomer_meets_everybody_well_before_their_next_announcement(robot):
    """Without the scout every second round takes up to 3 s; a busy machine may spoil some series."""

    def meets_at_once():
        nodes, _, fairly = seconds_until_complete()
        return "/robot/driver" in nodes and fairly < 2.0

    assert any(all(meets_at_once() for _ in range(ROUNDS)) for _ in range(5))


@pytest.fixture
def first_contact(monkeypatch):
    """Shorten the time [s] to wait for participants that may not exist."""
    monkeypatch.setattr(graph, "FIRST_CONTACT", 1.2)
    return 1.2


def test_without_a_table_of_ports_it_takes_as_long_as_announcements_do(robot, monkeypatch, tmp_path, first_contact):
    monkeypatch.setattr(discovery, "_PORT_TABLE", tmp_path / "none")
    _, taken, fairly = seconds_until_complete()
    assert first_contact <= taken and fairly < first_contact + 1.0


def test_a_program_that_is_no_participant_is_not_waited_for_for_ever(robot, ros_domain, first_contact):
    """Its port is one of the domain, so it might be a node that is starting."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        stranger.bind(("", 7410 + 250 * ros_domain + 2 * 100))
        _, taken, fairly = seconds_until_complete()
        assert first_contact <= taken and fairly < first_contact + 1.0


class FakeNode:
    """A node that knows only one participant: itself."""

    def get_name(self):
        return "fake"

    def get_publishers_info_by_topic(self, topic, no_mangle=False):
        return [argparse.Namespace(node_name="fake", endpoint_gid=bytes(range(24)))]


HEADING = "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode\n"


@pytest.mark.parametrize(
    ("ports", "known"),
    [
        ({7660: 11}, True),
        ({7660: 11, 7662: 12}, False),
        ({7660: 11, 7661: 12, 7650: 13, 7900: 14, 7658: 15}, True),
        ({}, None),
        ({7662: 12}, None),
    ],
)
def test_everybody_is_known_if_no_port_of_the_domain_is_a_stranger(monkeypatch, tmp_path, ports, known):
    lines = [
        f"  1: 00000000:{port:04X} 00000000:0000 07 00000000:00000000 00:00000000 00000000 0 0 {inode} 2 0 0\n"
        for port, inode in ports.items()
    ]
    table = tmp_path / "udp"
    table.write_text(HEADING + "".join(lines))
    files = tmp_path / "fd"
    files.mkdir()
    (files / "3").symlink_to("socket:[11]")
    (files / "4").symlink_to("/dev/null")
    monkeypatch.setattr(discovery, "_PORT_TABLE", table)
    sent = []
    monkeypatch.setattr(discovery, "_send_scout", lambda *call: sent.append(call))
    participants = Participants(domain=1)
    monkeypatch.setattr(discovery, "_OWN_FILES", files)
    participants.attach(FakeNode())
    assert participants.all_known() is known
    assert participants.all_known() is known
    assert sent == ([(7660, [7662], bytes([0, 1, 2, 3]))] if known is False else []), "one scout, not one a question"
