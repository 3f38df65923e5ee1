"""Sleeping takes simulated time: in callbacks, in threads, in loops, and with every timeout."""

import textwrap

import pytest

NOW = """
import time
began = time.monotonic()
said = node.create_publisher(String, "/said", 10)
def say(text):
    clock = node.get_clock().now().nanoseconds / 1e9
    said.publish(String(data=f"{text} {time.monotonic() - began:.3f} {clock:.1f}"))
"""


@pytest.fixture
def heard(play):
    """What a node says that has `say(text)`: the text, the seconds on the computer's clock, those on the node's."""

    def call(code, ticks=10, **more):
        played = play(ticks=ticks, holding=False, simulated=True, node=NOW + textwrap.dedent(code), **more)
        assert played.pace.paced_ticks == 0, played.lines
        return played.heard

    return call


WAYS = {
    "time.sleep": "time.sleep(0.3)",
    "the node's clock": "node.get_clock().sleep_for(rclpy.duration.Duration(seconds=0.3))",
    "a steady clock": "Clock(clock_type=ClockType.STEADY_TIME).sleep_for(rclpy.duration.Duration(seconds=0.3))",
    "an event": "threading.Event().wait(0.3)",
    "a condition": "condition.acquire(); condition.wait_for(lambda: False, 0.3)",
    "a queue": "take()",
    "a thread": "idler.join(0.3)",
    "a future": "result()",
    "select": "select.select([], [], [], 0.3)",
    "asyncio": "asyncio.run(asyncio.sleep(0.3))",
    "the clock": "ask_until(time.time() + 0.3)",
}
TOOLS = """
import asyncio, concurrent.futures, contextlib, queue, select, threading
import rclpy.duration
from rclpy.clock import Clock, ClockType
condition = threading.Condition()
idler = threading.Thread(target=threading.Event().wait, daemon=True)
idler.start()
def take():
    with contextlib.suppress(queue.Empty):
        queue.Queue().get(timeout=0.3)
def result():
    with contextlib.suppress(TimeoutError):
        concurrent.futures.Future().result(0.3)
def ask_until(end):
    while time.time() < end:
        pass
"""


QUICK = ("time.sleep", "an event", "a queue", "asyncio", "the clock")


@pytest.mark.parametrize("way", [pytest.param(way, marks=() if way in QUICK else pytest.mark.proof) for way in WAYS])
def test_a_thread_sleeps_in_simulated_time(heard, way):
    code = f"""
{TOOLS}
def work():
    time.sleep(0.1)
    say("begins")
    {WAYS[way]}
    say("ends")
threading.Thread(target=work, daemon=True).start()
rclpy.spin(node)
"""
    said = heard(code, ticks=6)
    # Who sleeps until the moment of a tick wakes before its /clock comes; who waits for /clock wakes with it.
    ends = "ends 0.300 0.3" if way == "the node's clock" else "ends 0.400 0.3"
    assert said == ["begins 0.100 0.0", ends]


@pytest.mark.parametrize(
    "wait",
    [
        "rclpy.spin_once(node, timeout_sec=0.3)",
        "rclpy.spin_until_future_complete(node, Future(), timeout_sec=0.3)",
        "end = time.time() + 0.3\nwhile time.time() < end: rclpy.spin_once(node, timeout_sec=0.01)",
        "end = time.time() + 0.3\nwhile time.time() < end: rclpy.spin_once(node, timeout_sec=0)",
    ],
    ids=["spin_once", "future", "loop", "poll"],
)
def test_the_timeout_of_a_spin_is_simulated_time(play, wait):
    code = (
        f"from rclpy.task import Future\nnode = Node('plain', use_global_arguments=False)\n{NOW}\n{wait}\nsay('over')\n"
    )
    played = play(ticks=6, holding=False, simulated=True, node=code + "rclpy.spin(node)")
    assert played.pace.paced_ticks == 0
    assert [line.split()[:2] for line in played.heard] == [["over", "0.300"]]


def test_shorter_sleeps_than_a_tick_come_one_after_the_other(heard):
    code = """
    import threading
    def work():
        for number in range(6):
            time.sleep(0.04)
            say(str(number))
    threading.Thread(target=work, daemon=True).start()
    rclpy.spin(node)
    """
    assert [line.split()[:2] for line in heard(code, ticks=4)] == [[str(n), f"{0.04 * (n + 1):.3f}"] for n in range(6)]


def test_sleepers_wake_in_the_order_of_their_time_then_of_their_start(heard):
    code = """
    import threading
    def work(name, seconds):
        for _ in range(2):
            time.sleep(seconds)
            say(name)
    for name, seconds in (("slow", 0.2), ("b", 0.1), ("a", 0.1)):
        threading.Thread(target=work, args=(name, seconds), daemon=True).start()
    rclpy.spin(node)
    """
    said = [line.split()[:2] for line in heard(code, ticks=5)]
    assert said == [
        ["b", "0.100"],
        ["a", "0.100"],
        ["slow", "0.200"],
        ["b", "0.200"],
        ["a", "0.200"],
        ["slow", "0.400"],
    ]


def test_messages_queue_up_while_a_callback_sleeps_and_the_oldest_are_lost(play):
    code = """
    import time
    said = node.create_publisher(String, "/said", 10)
    def hear(message):
        time.sleep(0.45)
        said.publish(String(data=str(message.data)))
    node.create_subscription(Int32, "/numbers", hear, 2)
    rclpy.spin(node)
    """
    counter = """
    numbers = node.create_publisher(Int32, "/numbers", 10)
    count = 0
    def tick():
        global count
        count += 1
        numbers.publish(Int32(data=count))
    node.create_timer(0.1, tick)
    rclpy.spin(node)
    """
    runs = [play(ticks=25, simulated=True, counter=counter, ear=code) for _ in range(2)]
    assert [run.pace.paced_ticks for run in runs] == [0, 0]
    assert runs[0].heard == runs[1].heard == ["1", "4", "8", "13", "17"]


def test_a_callback_that_sleeps_in_a_pool_holds_only_its_group(heard):
    code = """
    from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
    from rclpy.executors import MultiThreadedExecutor
    def slow():
        timer.cancel()
        time.sleep(0.5)
        say("slow")
    timer = node.create_timer(0.1, slow, callback_group=MutuallyExclusiveCallbackGroup())
    node.create_timer(0.2, lambda: say("quick"), callback_group=MutuallyExclusiveCallbackGroup())
    executor = MultiThreadedExecutor(3)
    executor.add_node(node)
    executor.spin()
    """
    assert [line.split()[0] for line in heard(code, ticks=8)] == ["quick", "quick", "slow", "quick", "quick"]


def test_a_rate_in_a_thread_is_held(heard):
    code = """
    import threading
    def work():
        rate = node.create_rate(10)
        for number in range(3):
            rate.sleep()
            say(str(number))
    threading.Thread(target=work, daemon=True).start()
    rclpy.spin(node)
    """
    assert heard(code, ticks=5) == ["0 0.100 0.1", "1 0.200 0.2", "2 0.300 0.3"]


def test_a_thread_that_waits_in_c_holds_nobody_up(heard):
    code = """
    import os, threading
    reading, writing = os.pipe()
    threading.Thread(target=os.read, args=(reading, 1), daemon=True).start()
    node.create_timer(0.1, lambda: say("tick"))
    rclpy.spin(node)
    """
    assert len(heard(code, ticks=5)) == 5


def test_a_worker_has_answered_before_time_goes_on(heard):
    code = """
    import queue, threading
    work = queue.Queue()
    def answer():
        while True:
            number = work.get()
            sum(range(10**6))
            say(str(number))
    threading.Thread(target=answer, daemon=True).start()
    node.create_timer(0.1, lambda: work.put(len(seen) or seen.append(1)))
    seen = []
    rclpy.spin(node)
    """
    assert [line.split()[2] for line in heard(code, ticks=4)] == ["0.1", "0.2", "0.3", "0.4"]


def test_the_wait_for_a_child_takes_real_time(heard):
    code = """
import subprocess, sys
CHILD = "import os, time; os.close(1); os.close(2); time.sleep(0.3)"
def work():
    timer.cancel()
    subprocess.run([sys.executable, "-S", "-c", CHILD], capture_output=True, timeout=100)
    say("has ended")
timer = node.create_timer(0.1, work)
rclpy.spin(node)
"""
    assert heard(code, ticks=4) == ["has ended 0.100 0.1"]


@pytest.mark.proof
def test_a_node_that_comes_between_two_ticks_gets_the_time_at_once(play):
    code = """
    import time
    time.sleep(0.15)
    node.destroy_node()
    node = Node("second")
    said = node.create_publisher(String, "/said", 10)
    node.create_timer(0.1, lambda: said.publish(String(data=str(node.get_clock().now().nanoseconds // 10**8))))
    rclpy.spin(node)
    """
    played = play(ticks=5, simulated=True, holding=False, node=code)
    assert (played.heard[-3:], played.pace.paced_ticks) == (["3", "4", "5"], 0), played.lines
