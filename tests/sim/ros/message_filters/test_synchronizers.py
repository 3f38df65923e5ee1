"""The synchronizers give the sets that a search through everything received so far finds."""

import itertools

import pytest
from geometry_msgs.msg import PointStamped, Twist
from hypothesis import given
from hypothesis import strategies as st
from rclpy.time import Time

from gz_course.sim.ros.message_filters import (
    ApproximateTimeSynchronizer,
    Cache,
    Chain,
    SimpleFilter,
    TimeSynchronizer,
)

MS = 1_000_000


def stamped(ms, name=""):
    message = PointStamped()
    message.header.stamp = Time(nanoseconds=ms * MS).to_msg()
    message.header.frame_id = name
    return message


def ms_of(message):
    return Time.from_msg(message.header.stamp).nanoseconds // MS


def run(make, arrivals, inputs=2):
    """Return the sets of stamps [ms] that come out for arrivals of (input, stamp [ms])."""
    sources = [SimpleFilter() for _ in range(inputs)]
    synchronizer = make(sources)
    sets = []
    synchronizer.registerCallback(lambda *messages: sets.append(tuple(ms_of(each) for each in messages)))
    for index, ms in arrivals:
        sources[index].signalMessage(stamped(ms, str(index)))
    return sets


@pytest.mark.parametrize(
    ("arrivals", "size", "sets"),
    [
        ([(0, 1), (1, 1)], 5, [(1, 1)]),
        ([(0, 1), (1, 2), (0, 2)], 5, [(2, 2)]),
        ([(0, 1), (0, 2), (1, 2), (1, 1)], 5, [(2, 2)]),  # older than a set: dropped
        ([(0, 1), (0, 2), (0, 3), (1, 1)], 2, []),  # only two are kept
        ([(0, 3), (0, 1), (1, 1)], 1, []),  # the latest stamp is kept, not the latest arrival
        ([(0, 1), (0, 1), (1, 1), (1, 1)], 5, [(1, 1)]),
    ],
)
def test_equal_stamps(arrivals, size, sets):
    assert run(lambda sources: TimeSynchronizer(sources, size), arrivals) == sets


@pytest.mark.parametrize(
    ("arrivals", "sets"),
    [
        ([(0, 0), (1, 9)], [(0, 9)]),
        ([(0, 0), (1, 10)], []),  # exactly the slop is too much
        ([(0, 0), (0, 8), (1, 6)], [(8, 6)]),  # the nearest
        ([(0, 0), (1, 3), (1, 4)], [(0, 3)]),  # a message is used once
        ([(0, 20), (1, 0), (0, 5)], [(5, 0)]),
    ],
)
def test_similar_stamps(arrivals, sets):
    assert run(lambda sources: ApproximateTimeSynchronizer(sources, 10, 0.010), arrivals) == sets


stamps = st.lists(st.tuples(st.integers(0, 2), st.integers(0, 30)), max_size=25)


@given(stamps, st.integers(1, 12), st.integers(1, 4))
def test_similar_stamps_of_three_inputs(arrivals, slop, size):
    """Of all possible sets, that with the nearest message of the first input is taken, then of the second and so on."""
    queues = [[], [], []]  # in the order of arrival
    wanted = []
    for index, ms in arrivals:
        if ms not in queues[index]:
            queues[index].append(ms)
        if len(queues[index]) > size:
            queues[index].remove(min(queues[index]))
        sets = [each for each in itertools.product(*queues) if each[index] == ms and max(each) - min(each) < slop]
        if sets:
            best = min(sets, key=lambda s: [(abs(t - ms), q.index(t)) for t, q in zip(s, queues, strict=True)])
            wanted.append(best)
            for queue, used in zip(queues, best, strict=True):
                queue.remove(used)
    assert run(lambda sources: ApproximateTimeSynchronizer(sources, size, slop / 1000), arrivals, 3) == wanted


def test_messages_without_header(capfd):
    kept, dropped, exact = SimpleFilter(), SimpleFilter(), SimpleFilter()
    seen = []
    ApproximateTimeSynchronizer([kept], 1, 0.1, allow_headerless=True).registerCallback(seen.append)
    ApproximateTimeSynchronizer([dropped], 1, 0.1).registerCallback(seen.append)
    message = Twist()
    kept.signalMessage(message)
    dropped.signalMessage(message)
    assert seen == [message]
    assert "allow_headerless" in capfd.readouterr().err
    TimeSynchronizer([exact], 1)
    with pytest.raises(AttributeError):
        exact.signalMessage(message)


def test_the_time_of_arrival_can_count_instead_of_stamps():
    first, second = SimpleFilter(), SimpleFilter()
    seen = []
    by_arrival = ApproximateTimeSynchronizer([first, second], 5, 60.0, sync_arrival_time=True)
    by_arrival.registerCallback(lambda *messages: seen.append([ms_of(each) for each in messages]))
    first.signalMessage(stamped(0))
    second.signalMessage(stamped(1_000_000))
    assert seen == [[0, 1_000_000]]


def test_a_callback_that_fails_does_not_block_the_next():
    source = SimpleFilter()
    synchronizer = TimeSynchronizer([source], 5)
    connection = synchronizer.registerCallback(lambda message: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        source.signalMessage(stamped(1))
    del synchronizer.callbacks[connection]
    seen = []
    synchronizer.registerCallback(lambda message, word: seen.append(word), "again")
    source.signalMessage(stamped(2))
    assert seen == ["again"]


def test_cache(capfd):
    source = SimpleFilter()
    cache = Cache(source, 3)
    assert (cache.getLast(), cache.getLastestTime(), cache.getOldestTime()) == (None, None, None)
    passed = []
    cache.registerCallback(passed.append)
    for ms in (0, 10, 20, 30):
        source.signalMessage(stamped(ms))

    def at(ms):
        return Time.from_msg(stamped(ms).header.stamp)

    assert [ms_of(each) for each in passed] == [0, 10, 20, 30]
    assert [ms_of(each) for each in cache.getInterval(at(10), at(20))] == [10, 20]
    assert [ms_of(each) for each in cache.getInterval(at(0), at(19))] == [10]
    assert (ms_of(cache.getElemAfterTime(at(11))), ms_of(cache.getElemBeforeTime(at(29)))) == (20, 20)
    assert (cache.getElemAfterTime(at(31)), cache.getElemBeforeTime(at(9))) == (None, None)
    assert (cache.getLastestTime(), cache.getOldestTime(), ms_of(cache.getLast())) == (at(30), at(10), 30)
    with pytest.raises(AssertionError):
        cache.getInterval(at(2), at(1))
    source.signalMessage(Twist())
    assert len(passed) == 4 and "allow_headerless" in capfd.readouterr().err
    headerless = Cache(source, 1, allow_headerless=True)
    source.signalMessage(message := Twist())
    assert headerless.getLast() is message


class Double(SimpleFilter):
    def add(self, number):
        self.signalMessage(2 * number)


def test_chain():
    source = SimpleFilter()
    chain, seen = Chain(source), []
    chain.registerCallback(seen.append)
    source.signalMessage(1)
    first, second = Double(), Double()
    beside = []
    for each in (first, second):
        chain.addFilter(each)
        each.registerCallback(beside.append)
    source.signalMessage(1)
    assert seen == [1, 4] and sorted(beside) == [2, 4]
    assert chain.getFilter(1) is second
    with pytest.raises(KeyError):
        chain.getFilter(2)
    with pytest.raises(RuntimeError, match="Already connected"):
        chain.connectInput(source)
