"""Requests to the stepping thread: which thread runs them, when, and who gets the result."""

from __future__ import annotations

import logging
import threading

import pytest

from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.requests import Request, Requests, logged


def elsewhere(requests: Requests, work: object, patience: float = 20.0) -> tuple[threading.Thread, list[object]]:
    """Call from another thread; its result or error is appended to the returned list."""
    results: list[object] = []

    def run() -> None:
        try:
            results.append(requests.call(work, patience))  # type: ignore[arg-type]
        except Exception as error:
            results.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    return thread, results


def test_the_stepping_thread_serves_itself_at_once() -> None:
    requests = Requests()
    assert requests.call(lambda: 42) == 42
    assert requests.put(lambda: 7).result == 7
    with pytest.raises(ValueError, match="no"):
        requests.call(lambda: int("no"))


def test_others_wait_until_they_are_served_in_the_thread_that_steps() -> None:
    requests = Requests()
    thread, results = elsewhere(requests, threading.get_ident)
    while not results:
        requests.wait(1.0)
        requests.serve()
    thread.join(120)
    assert results == [threading.get_ident()]
    assert not requests


def test_errors_go_to_who_asked() -> None:
    requests = Requests()
    thread, results = elsewhere(requests, lambda: 1 / 0)
    requests.wait(20.0)
    requests.serve()
    thread.join(120)
    assert isinstance(results[0], ZeroDivisionError)


def test_inside_a_step_work_waits_and_a_call_is_refused() -> None:
    requests = Requests()
    done: list[int] = []
    requests.enter_step()
    requests.put(lambda: done.append(1))
    with pytest.raises(SimError, match="middle of a step"):
        requests.call(lambda: done.append(2))
    requests.leave_step()
    assert done == []
    requests.serve()
    assert done == [1], "the refused call is never done"


def test_work_that_was_given_up_is_never_done() -> None:
    requests = Requests()
    done: list[int] = []
    thread, results = elsewhere(requests, lambda: done.append(1), 0.01)
    thread.join(120)
    assert isinstance(results[0], SimError) and "not stepped for 0.01 s" in str(results[0])
    requests.serve()
    assert done == []


def test_work_may_ask_for_more_work() -> None:
    requests = Requests()
    done: list[str] = []
    requests.enter_step()
    requests.put(lambda: (done.append("first"), requests.put(lambda: done.append("second"))))
    requests.leave_step()
    requests.serve()
    assert done == ["first", "second"]


def test_errors_that_nobody_waits_for_are_one_sentence(caplog: pytest.LogCaptureFixture) -> None:
    def refuse() -> None:
        raise SimError("no such thing")

    assert logged(refuse, "/world/w/create")() is False
    assert logged(lambda: 1 / 0, "/world/w/create")() is False
    assert logged(lambda: None, "/world/w/create")() is True
    spoken = [record.getMessage() for record in caplog.records if record.levelno == logging.ERROR]
    assert spoken[0] == "/world/w/create: no such thing"
    assert spoken[1].startswith("/world/w/create: it failed inside the simulator (ZeroDivisionError")


def test_a_world_goes_on_however_much_is_asked_for() -> None:
    from gz_course.sim.gz.sim.world import World

    world = World.from_string("<sdf version='1.10'><world name='w'/></sdf>")
    asked: list[int] = []

    def again() -> None:
        asked.append(world.iterations)
        world.requests.waiting.append(Request(again))

    world.requests.waiting.append(Request(again))
    world.step(5)
    assert world.iterations == 5 and asked == [0, 1, 2, 3, 4]


def test_who_begins_to_step_waits_for_what_is_being_done_at_once() -> None:
    requests = Requests()
    begun: list[str] = []
    thread = threading.Thread(target=lambda: (requests.own(), begun.append("step")))

    def work() -> None:
        thread.start()
        thread.join(0.2)
        begun.append("work")

    requests.put(work)
    thread.join(120)
    assert begun == ["work", "step"]


def test_who_stepped_first_is_served_by_who_steps_now() -> None:
    requests = Requests()
    thread = threading.Thread(target=requests.serve)
    thread.start()
    thread.join(120)
    asked = requests.put(threading.get_ident)
    assert not asked.done.is_set()
    requests.serve()
    assert asked.result == threading.get_ident()
