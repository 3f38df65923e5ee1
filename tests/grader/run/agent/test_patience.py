"""What a process of the submission waits for, it waits for by the clock of the run, which the grader tells."""

from types import SimpleNamespace

import pytest

from gz_course.grader.run.agent.course_agent import grader_requests, patience
from gz_course.grader.run.agent.course_agent.channel import Channel
from gz_course.grader.run.agent.course_agent.executor_monitor import ExecutorMonitor
from gz_course.grader.run.agent.course_agent.patience import await_found, await_signal
from gz_course.grader.run.agent.course_agent.rclpy_7_1_waits import SERVICE_PATIENCE, may_ask
from gz_course.grader.run.agent.course_agent.signals import Signal
from gz_course.grader.run.agent.course_agent.thread_monitor import ThreadMonitor


@pytest.fixture
def grader(monkeypatch):
    """A grader whose clock advances by a second each time it is asked; `answers` are given instead, one by one."""
    told = SimpleNamespace(now=0.0, asked=0, answers=[])

    def ask(question):
        told.asked += 1
        told.now += 1.0
        return told.answers.pop(0) if told.answers else {"now": told.now, "others": False}

    monkeypatch.setattr(grader_requests, "ask", ask)
    monkeypatch.setattr(patience, "SLICE", 0.0)
    monkeypatch.setattr(patience, "ASKING", 0.0)
    return told


def test_a_signal_is_awaited_by_the_clock_of_the_run(grader):
    signal = Signal()
    assert not await_signal(ThreadMonitor(), signal, 30.0)
    assert grader.asked == 31
    signal.set()
    assert await_signal(ThreadMonitor(), signal, 30.0)
    assert grader.asked == 31


def test_a_machine_that_stands_still_takes_no_patience_away(grader):
    grader.answers = [{"now": 5.0}] * 200
    assert not await_signal(ThreadMonitor(), Signal(), 10.0)
    assert grader.asked > 200


def test_a_grader_that_has_gone_is_not_waited_for(grader):
    grader.answers = [{"error": "the simulator has gone"}] * 2
    assert not await_signal(ThreadMonitor(), Signal(), 10.0)
    assert not await_found(ThreadMonitor(), lambda: True, lambda: 0, 10.0)
    assert grader.asked == 2


def test_what_discovery_may_find_is_looked_for_while_others_are_at_work(grader):
    grader.answers = [{"now": float(each), "others": True} for each in range(20)]
    looks = iter([*[0] * 25, 1])
    assert await_found(ThreadMonitor(), lambda: True, lambda: next(looks), 10.0)
    assert not await_found(ThreadMonitor(), lambda: True, lambda: 0, 10.0)


def test_a_request_leaves_when_its_server_is_found_or_was_looked_for_long_enough():
    found = [False]
    client = SimpleNamespace()
    may = may_ask(client, lambda: found[0])
    assert not may(7.0) and not may(7.0 + 0.9 * SERVICE_PATIENCE)
    found[0] = True
    assert may(7.0)
    found[0] = False
    assert may(7.0 + SERVICE_PATIENCE)
    assert may_ask(client, lambda: found[0])(7.0 + SERVICE_PATIENCE)  # the second does not wait


def test_a_message_that_may_not_leave_yet_stays_where_it_is(tmp_path):
    monitor = ExecutorMonitor(Channel(f"{tmp_path}/nobody"), {}, True)
    monitor._channel.open = True  # as if somebody were there
    sent = []
    monitor.hold(lambda: sent.append("request"), lambda now: now >= 2.0)
    monitor.hold(lambda: sent.append("message"))
    for now, expected in ((1.0, []), (2.0, ["request"]), (0.0, ["request", "message"])):
        monitor._obey({"release": now})
        assert sent == expected
    assert monitor._held.released == 3


def test_who_makes_a_node_is_at_work_whatever_it_has_waited_for_unseen(tmp_path):
    monitor = ExecutorMonitor(Channel(f"{tmp_path}/nobody"), {}, True)
    threads = monitor.threads
    threads.enter(threads.expect())
    threads._working.clear()  # as after a long read of a file
    assert threads.idle
    monitor.add_node(SimpleNamespace(_publishers=[], _subscriptions=[], publishers=[], subscriptions=[]))
    assert not threads.idle
