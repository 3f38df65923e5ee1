"""The clocks of a process of the submission, in simulated time."""

import os
import threading
import time

from hypothesis import example, given
from hypothesis import strategies as st

from gz_course.grader.run.agent.course_agent.thread_monitor import ThreadMonitor

MILLISECOND = 1_000_000


@given(
    base=st.integers(10**9, 2 * 10**18),
    begin=st.integers(0, 60_000),
    wait=st.integers(20, 4_900),
    rate=st.sampled_from([1.0, 2.0, 0.5]),
)
@example(base=1_795_364_000_100_000_001, begin=100, wait=200, rate=1.0)
def test_a_deadline_in_floats_is_reached_when_its_time_has_come_and_not_before(base, begin, wait, rate):
    """A loop that waits until `time.time() + 0.3` ends at 0.3 s: not a round later because floats are rounded."""
    threads = ThreadMonitor()
    threads.start(0, rate)
    threads._bases["time"] = base

    def shown(milliseconds):
        threads.tell(milliseconds * MILLISECOND)
        return threads.clock_ns("time", time.time_ns) / 1e9

    start = shown(begin)
    seconds = wait / 1000 / rate
    end = start + seconds
    assert threads.after(seconds) == (begin + wait) * MILLISECOND
    # Who is woken on the way waits for the rest, in whole milliseconds.
    left = end - shown(begin + wait // 2)
    assert threads.after(left) == (begin + wait) * MILLISECOND
    assert shown(begin + wait - 1) < end
    assert shown(begin + wait) >= end and shown(begin + wait) - start >= seconds


def test_what_a_process_computes_before_its_first_node_takes_no_time_and_what_it_sleeps_does():
    """A node that measures from the start of its program sees the same on a slow machine."""
    threads = ThreadMonitor()
    threads.enter(threads.expect())
    assert threads.clock_ns("time", lambda: 7_000) == 7_000
    with threads.waiting():
        time.sleep(0.001)
    slept = threads._slept_ns
    assert slept >= MILLISECOND
    threads.start(0, 1.0)
    assert threads.clock_ns("time", lambda: 10**9) == 7_000 + slept
    assert threads.clock_ns("monotonic", lambda: 0) <= time.monotonic_ns()


def test_who_waits_for_a_thread_that_runs_is_no_stray():
    """A thread that waits for a lock goes on at once when it gets it, however long the other was kept from running."""
    threads = ThreadMonitor()
    reading, writing = os.pipe()
    go_on, native = threading.Event(), {}

    def watched(work):
        number, begun = threads.expect(), threading.Event()

        def run():
            threads.enter(number)
            native[threading.get_ident()] = threading.get_native_id()
            begun.set()
            work()
            threads.leave()

        thread = threading.Thread(target=run)
        thread.start()
        begun.wait()
        return thread

    def compute():
        while not go_on.is_set():
            pass

    def looked(until):
        while not until():
            threads.look_for_strays(native)
            time.sleep(0.005)  # lets the others run

    waiting, computing = watched(lambda: os.read(reading, 1)), watched(compute)
    looks = iter(range(5))
    looked(lambda: next(looks, None) is None)
    assert len(threads._working) == 2
    go_on.set()
    computing.join()
    looked(lambda: threads.idle)
    os.write(writing, b"x")
    waiting.join()
    os.close(reading), os.close(writing)
