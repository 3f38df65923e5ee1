"""The network interfaces that a process uses, and its messages if none can be used."""

import os
import shutil
import socket
import subprocess
import sys

import pytest

from gz_course.sim.gz.transport.address import is_of_this_machine, is_usable, within_reach

ADVERTISE = """
import sys
from gz.msgs.stringmsg_pb2 import StringMsg
from gz.transport import Node
node = Node()
try:
    node.advertise("/chat", StringMsg)
    node.advertise_service("/echo", StringMsg, StringMsg, lambda request: request)
    node.request("/nobody", StringMsg(), StringMsg, StringMsg, 10)
    print(node.topic_list())
except OSError as error:
    sys.exit(str(error))
"""
SECOND_INTERFACE = (
    "ip link set lo up && ip link add a0 type veth peer name a1 && ip addr add 10.77.0.1/24 dev a0 && "
    "ip link set a0 up && ip link set a1 up && ip route add 224.0.0.0/4 dev a0"
)
COUNT = "echo sent $(awk '$1 == \"a0:\" {print $11}' /proc/net/dev)"
# IPv6 sends packets on a new interface at arbitrary times.
QUIET = "for all in /proc/sys/net/ipv6/conf/all/disable_ipv6; do [ ! -e $all ] || echo 1 >$all; done"


def run(command, **environment):
    return subprocess.run(
        command, capture_output=True, text=True, timeout=600, env={**os.environ, "GZ_PARTITION": "p", **environment}
    )


def in_namespace(script, **environment):
    """Run a shell script in a network namespace of its own."""
    if shutil.which("unshare") is None or run(["unshare", "-rn", "true"]).returncode != 0:
        pytest.skip("NOT TESTED: which interfaces are used; `unshare -rn` is not possible on this machine")
    return run(["unshare", "-rn", "sh", "-c", script], **environment)


@pytest.mark.parametrize(("ip", "sends"), [("", False), ("127.0.0.1", False), ("10.77.0.1", True)])
def test_packets_leave_by_another_interface_only_if_gz_ip_asks(ip, sends):
    script = f"{QUIET}; {SECOND_INTERFACE} && {COUNT} && \"{sys.executable}\" -c '{ADVERTISE}' && {COUNT}"
    done = in_namespace(script, GZ_IP=ip)
    if "a0" in done.stderr or "veth" in done.stderr:
        pytest.skip(f"NOT TESTED: no second interface can be made: {done.stderr}")
    before, listed, after = done.stdout.splitlines()
    assert listed == "['/chat']"
    grown = int(after.split()[1]) - int(before.split()[1])
    assert grown > 3 if sends else grown == 0


def test_loopback_that_is_down_is_one_sentence():
    done = in_namespace(f"\"{sys.executable}\" -c '{ADVERTISE}'")
    assert done.returncode == 1
    assert "the loopback interface is down: `ip link set lo up` starts it." in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("variable", ["GZ_DISCOVERY_MSG_PORT", "GZ_DISCOVERY_SRV_PORT"])
def test_a_port_that_somebody_keeps_to_himself_is_one_sentence(variable):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as selfish:
        selfish.bind(("0.0.0.0", 0))
        port = selfish.getsockname()[1]
        done = run([sys.executable, "-c", ADVERTISE], **{variable: str(port)})
    assert done.returncode == 1
    assert f"another program keeps the UDP port {port} to itself" in done.stderr
    assert f"set {variable} to another port" in done.stderr
    assert done.stderr.count("\n") == 1


def test_an_address_of_another_machine_is_replaced():
    done = run([sys.executable, "-c", ADVERTISE], GZ_IP="203.0.113.7")
    assert done.returncode == 0
    assert "Did you set the environment variable GZ_IP to an address of this machine? 127.0.0.1 is used" in done.stderr


def test_addresses_of_others():
    assert is_of_this_machine("127.0.0.1")
    assert is_of_this_machine("127.3.2.1")
    assert not is_of_this_machine("203.0.113.7")
    assert not is_of_this_machine("0.0.0.0")
    assert not within_reach("203.0.113.7", "127.0.0.1")
    assert within_reach("203.0.113.7", "192.168.1.2")
    assert is_usable("tcp://127.0.0.1:1", "127.0.0.1")
    assert is_usable("tcp://203.0.113.7:65535", "192.168.1.2")
    for address in (
        *("tcp://203.0.113.7:80", "tcp://example.org:80", "tcp://127.0.0.1:0", "tcp://127.0.0.1:65536"),
        *("tcp://127.0.0.1", "tcp://*:80", "tcp://300.0.0.1:80", "ipc:///tmp/x", "", "tcp://127.0.0.1:80\x00"),
    ):
        assert not is_usable(address, "127.0.0.1")
