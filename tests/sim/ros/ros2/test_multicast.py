"""`ros2 multicast` and `ros2 doctor hello`, on the loopback interface."""

import argparse
import socket

import pytest
from std_msgs.msg import String

from gz_course.sim.ros.ros2 import graph, hello, multicast
from gz_course.sim.ros.ros2.command.multicast import receive, send
from gz_course.sim.ros.ros2.errors import CommandError


@pytest.fixture(autouse=True)
def port(ros_domain, monkeypatch):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        monkeypatch.setattr(multicast, "PORT", free.getsockname()[1])


def test_what_is_sent_is_received(capsys, monkeypatch):
    monkeypatch.setattr(receive, "print", lambda text: (print(text), _send_when_waiting(text)), raising=False)
    receive.main(argparse.Namespace())
    lines = capsys.readouterr().out.splitlines()
    assert lines[:2] == ["Waiting for UDP multicast datagram...", "Sending one UDP multicast datagram..."]
    assert lines[2].startswith("Received from 127.0.0.1:")
    assert lines[2].endswith(": 'Hello World!'")


def _send_when_waiting(text):
    if text.startswith("Waiting"):
        send.main(argparse.Namespace(ttl=1))


def test_without_multicast_it_is_one_sentence(monkeypatch):
    monkeypatch.setattr(multicast, "GROUP", "10.0.0.1")  # no address of a group
    with pytest.raises(
        CommandError, match=r"Multicast to 10[.]0[.]0[.]1:.* does not work here: .*DISCOVERY_RANGE=LOCALHOST"
    ):
        receive.main(argparse.Namespace())


def test_hello_counts_other_hosts_of_topic_and_multicast(robot, monkeypatch):
    greeting = "hello, it's me elsewhere"
    publisher = robot.create_publisher(String, "/can_you", 10)
    timer = robot.create_timer(0.05, lambda: publisher.publish(String(data=greeting)))
    tables = []

    def table(topic, period, sent, heard, caught):
        multicast.send(greeting.encode())
        tables.append((topic, heard["elsewhere"] > 0, caught["elsewhere"] > 0))
        if tables[-1][1:] == (True, True):
            raise KeyboardInterrupt

    monkeypatch.setattr(hello, "_print_table", table)
    monkeypatch.setenv("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")  # as the command sets it
    arguments = argparse.Namespace(topic="can_you", emit_period=0.02, print_period=0.1, ttl=None, once=False)
    hello.hello(arguments)
    graph.destroy_ended()
    assert tables[-1] == ("/can_you", True, True)
    robot.destroy_timer(timer)
    robot.destroy_publisher(publisher)


def test_the_table_is_that_of_ros_2(capsys):
    hello._print_table("/t", 1.0, 10, {"pc": 3}, {})
    lines = capsys.readouterr().out.splitlines()
    assert lines[1:3] == ["Topic: /t, Published Msg Count: 10", "Subscribed from:"]
    assert lines[4].split() == ["pc", "3"]
    assert lines[-1] == "-" * 60
