"""Processes that wait unseen while they start up, such as for a lock that DDS shares with other processes."""

import threading

import pytest

from gz_course.grader.run.agent.course_agent import thread_monitor
from gz_course.grader.run.agent.course_agent.thread_monitor import QUIET, SHORTEST_LOOK, ThreadMonitor

# `usleep` of the C library is a call that is not watched; the thread does not run meanwhile.
STARTS = """
import ctypes
from rclpy.impl.implementation_singleton import rclpy_implementation as rcl
wait = lambda seconds: ctypes.CDLL(None).usleep(int(seconds * 1e6))
def slowly(make, seconds):
    def call(*arguments):
        wait(seconds)
        return make(*arguments)
    return call
said = node.create_publisher(String, "/said", 10)
{slow}
node.create_subscription(Int32, "/numbers", print, 10)
count = 0
def tick():
    global count
    count += 1
    said.publish(String(data=f"{count} at {node.get_clock().now().nanoseconds // 10**8}"))
node.create_timer(0.1, tick)
rclpy.spin(node)
"""


@pytest.mark.parametrize(
    "slow",
    [
        pytest.param("wait(0.3)", id="between two endpoints"),
        pytest.param("rcl.Subscription = slowly(rcl.Subscription, 1.0)", id="while an endpoint is made"),
    ],
)
def test_simulated_time_does_not_begin_before_a_node_is_made(play, slow):
    run = play(node=STARTS.replace("{slow}", slow))
    assert run.pace.paced_ticks == 0, run.lines
    assert run.heard == [f"{n} at {n}" for n in range(1, 11)]


@pytest.fixture
def clock(monkeypatch):
    """The clock of the agent, in seconds, as a list of one number."""
    now = [100.0]
    monkeypatch.setattr(thread_monitor, "monotonic", lambda: now[0])
    return now


@pytest.mark.parametrize(
    ("step", "looks"),
    [pytest.param(0.05, round(QUIET / 0.05), id="looks"), pytest.param(9.0, round(QUIET / 0.1), id="stalls")],
)
def test_who_prepares_a_node_waits_unseen_once_it_has_not_run_for_long(clock, step, looks):
    """However long the machine stood still between two looks."""
    threads, done, native = ThreadMonitor(), threading.Event(), {}
    number, ready = threads.expect(), threading.Event()

    def prepare():
        threads.enter(number)
        threads.prepare()
        native[threading.get_ident()] = threading.get_native_id()
        ready.set()
        done.wait()

    thread = threading.Thread(target=prepare)
    thread.start()
    ready.wait()
    while not thread_monitor._scheduled(*native.values()):
        pass
    threads.look_for_strays(native)
    for _ in range(looks - 1):
        clock[0] += step
        threads.look_for_strays(native)
        assert not threads.idle
    clock[0] += 2 * step
    threads.look_for_strays(native)
    assert threads.idle
    done.set()
    thread.join()


def test_looks_at_the_same_moment_are_one_look(clock):
    """A process that gets no processor for a while finds several orders to look at once."""
    threads, done, native = ThreadMonitor(), threading.Lock(), {}
    number, ready, at_work = threads.expect(), threading.Event(), threading.Event()

    def work():
        threads.enter(number)
        native[threading.get_ident()] = threading.get_native_id()
        ready.set()
        done.acquire()
        with threads.at_work():
            at_work.set()
            done.acquire()

    done.acquire()
    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    ready.wait()
    while not thread_monitor._scheduled(*native.values()):
        pass
    for _ in range(5):
        threads.look_for_strays(native)
        clock[0] += SHORTEST_LOOK / 10
    assert not threads.idle
    clock[0] += SHORTEST_LOOK
    threads.look_for_strays(native)
    assert threads.idle, "it waits unseen"
    done.release()
    at_work.wait()
    assert not threads.idle, "who is known to work is counted again"
    done.release()
    thread.join()
