"""A ROS domain belongs to one run at a time, over all processes of the machine, and comes back with its process."""

import os
import socket
import subprocess
import sys

import pytest

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.run import domain as module
from gz_course.grader.run.domain import DOMAINS, Domain

HOLD = """
import sys
from gz_course.grader.run import domain
domain.RESERVED_AS = sys.argv[1]
d = domain.Domain()
print(d.id, flush=True)
sys.stdin.read()
"""


@pytest.fixture
def a_few(monkeypatch):
    """Keep the gradings of others out of ten domains, and reserve there under a name of our own."""
    held = [Domain() for _ in range(10)]
    monkeypatch.setattr(module, "RESERVED_AS", f"test-of-domains-{os.getpid()}")
    yield [domain.id for domain in held]
    for domain in held:
        domain.release()


@pytest.fixture
def holders(a_few):
    """Start processes that hold a domain each; returns their numbers."""
    started = []

    def start(count):
        new = [
            subprocess.Popen(
                [sys.executable, "-c", HOLD, module.RESERVED_AS],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
            for _ in range(count)
        ]
        started.extend(new)
        return [int(process.stdout.readline()) for process in new], new

    yield start
    for process in started:
        process.kill()
        process.communicate()


def test_processes_never_share_one(holders):
    numbers, _ = holders(8)
    assert len(set(numbers)) == 8
    with Domain() as mine, Domain() as another:
        assert len({mine.id, another.id, *numbers}) == 10


def test_domain_zero_and_those_with_ephemeral_ports_are_left_alone():
    assert min(DOMAINS) >= 1
    # The last port of a domain: 7400 + 250 * domain + 11 + 2 * participant; Linux hands out 32768 and up.
    assert 7400 + 250 * max(DOMAINS) + 11 + 2 * 5 < 32768


@pytest.fixture
def only_two(a_few, monkeypatch):
    """As if there were but two domains."""
    pair = sorted(a_few[:2])
    monkeypatch.setattr(module, "DOMAINS", range(pair[0], pair[1] + 1, pair[1] - pair[0]))


SPEAK = """
import sys
import rclpy
rclpy.init()
node = rclpy.create_node("left_over")
print(flush=True)
sys.stdin.read()
"""


@pytest.fixture
def speaker(monkeypatch):
    """Start a node in a domain that looks for others on this machine only, as a bridge that somebody has left."""
    started = []

    def start(number):
        monkeypatch.setenv("ROS_DOMAIN_ID", str(number))
        monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        process = subprocess.Popen([sys.executable, "-c", SPEAK], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        started.append(process)
        process.stdout.readline()

    yield start
    for process in started:
        process.kill()
        process.communicate()


def test_a_domain_in_which_somebody_speaks_comes_last(only_two, speaker):
    with Domain() as one:
        number = one.id
    speaker(number)
    with Domain() as quiet, Domain() as loud:
        assert quiet.id != number == loud.id


def test_a_domain_in_which_somebody_listens_to_all_the_network_comes_last(only_two):
    with Domain() as one:
        number = one.id
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listening:
        listening.bind(("", 7400 + 250 * number))
        with Domain() as quiet, Domain() as loud:
            assert quiet.id != number == loud.id


def test_when_all_are_taken_it_says_so(only_two):
    with Domain(), Domain(), pytest.raises(InfrastructureError, match="taken by other gradings"):
        Domain()


def test_a_released_one_can_be_had_again(only_two):
    with Domain() as one, Domain():
        number = one.id
        one.release()
        with Domain() as again:
            assert again.id == number


def test_a_killed_process_gives_its_domain_back(holders, monkeypatch):
    (number,), (process,) = holders(1)
    monkeypatch.setattr(module, "DOMAINS", range(number, number + 1))
    with pytest.raises(InfrastructureError):
        Domain()
    process.kill()
    process.wait()
    with Domain() as mine:
        assert mine.id == number
