import contextlib
import faulthandler
import json
import os
import queue
import signal
import socket
import subprocess
import sys
import threading
import time
import uuid
from pathlib import Path

import pytest

from gz_course.sim.gz.msgs.discovery_pb2 import Discovery
from gz_course.sim.gz.transport import datagram
from gz_course.tests.warm_process import WarmPopen

DEADLINE_S = 120.0


class Peer:
    """A child process that runs peer.py."""

    def __init__(self, environment):
        self.process = WarmPopen(
            [sys.executable, str(Path(__file__).with_name("peer.py"))],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, **environment},
            start_new_session=True,
        )
        self._answers = queue.Queue()
        self._heard = queue.Queue()
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self):
        for line in self.process.stdout:
            said = json.loads(line)
            if "heard" in said:
                self._heard.put(tuple(said["heard"]))
            else:
                self._answers.put(said["answer"])

    def ask(self, do, **arguments):
        self.process.stdin.write(json.dumps({"do": do, **arguments}) + "\n")
        self.process.stdin.flush()
        return self._answers.get(timeout=DEADLINE_S)

    def order(self, do):
        self.process.stdin.write(json.dumps({"do": do}) + "\n")
        self.process.stdin.flush()

    def heard(self, count=1):
        return [self._heard.get(timeout=DEADLINE_S) for _ in range(count)]

    def kill(self):
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait(DEADLINE_S)

    def finish(self):
        """Let the process end by itself; return (exit code, stderr)."""
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
        code = self.process.wait(DEADLINE_S)
        return code, self.process.stderr.read()

    def clean_up(self):
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()
        try:
            self.process.wait(5)
        except subprocess.TimeoutExpired:
            self.kill()
        self._reader.join(DEADLINE_S)
        self.process.stdout.close()
        self.process.stderr.close()


class Eavesdropper:
    """Receives and sends datagrams on the discovery port as a process of its own."""

    def __init__(self):
        self.process_uuid = str(uuid.uuid4())
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        interface = socket.inet_aton("127.0.0.1")
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, interface)
        group = socket.inet_aton("239.255.0.7")
        self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, group + interface)
        self._socket.bind(("0.0.0.0", 10317))

    def until(self, condition):
        """Return the messages up to the first one that fulfils the condition."""
        deadline = time.monotonic() + DEADLINE_S
        seen = []
        while True:
            if (left := deadline - time.monotonic()) <= 0:
                faulthandler.dump_traceback()  # where the threads of this process are
                raise AssertionError(f"not within {DEADLINE_S} s; {len(seen)} other messages came")
            self._socket.settimeout(left)
            try:
                message = datagram.decode(self._socket.recv(65535))
            except TimeoutError:
                continue
            if message is not None:
                seen.append(message)
                if condition(message):
                    return seen

    def send_bytes(self, data):
        self._socket.sendto(data, ("239.255.0.7", 10317))

    def advertise(self, name, address, type_name):
        message = Discovery(version=10, process_uuid=self.process_uuid, type=Discovery.ADVERTISE)
        message.pub.topic = name
        message.pub.address = address
        message.pub.process_uuid = self.process_uuid
        message.pub.node_uuid = str(uuid.uuid4())
        message.pub.scope = Discovery.Publisher.ALL
        message.pub.msg_pub.ctrl = "unused"
        message.pub.msg_pub.msg_type = type_name
        self.send_bytes(datagram.encode(message))

    def bye(self):
        message = Discovery(version=10, process_uuid=self.process_uuid, type=Discovery.BYE)
        self.send_bytes(datagram.encode(message))

    def close(self):
        self._socket.close()


@pytest.fixture(autouse=True)
def partition(monkeypatch):
    name = f"test-{uuid.uuid4()}"
    monkeypatch.setenv("GZ_PARTITION", name)
    monkeypatch.setenv("GZ_IP", "127.0.0.1")
    return name


@pytest.fixture
def start_peer(partition):
    peers = []

    def start(**environment):
        peers.append(Peer({"GZ_PARTITION": partition, **environment}))
        return peers[-1]

    yield start
    for peer in peers:
        peer.clean_up()


@pytest.fixture
def eavesdropper():
    with contextlib.closing(Eavesdropper()) as each:
        yield each


class Inbox:
    """A callback that stores its arguments and can be waited for."""

    def __init__(self):
        self._queue = queue.Queue()

    def __call__(self, message, *rest):
        self._queue.put(message)

    def take(self, count=1):
        return [self._queue.get(timeout=DEADLINE_S) for _ in range(count)]

    def empty(self):
        return self._queue.empty()


@pytest.fixture
def inbox():
    return Inbox()


@pytest.fixture
def new_inbox():
    return Inbox
