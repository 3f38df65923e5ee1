"""The echo filter drops exactly the echoes, for any messages in any order."""

from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.bridge.ros_gz_bridge.echo_filter import EchoFilter

US = 1000


def same(content):
    return content


class Clock:
    """A clock [ns] that advances only on request."""

    def __init__(self):
        self.now = 10**18

    def __call__(self):
        return self.now


def publish(echo_filter, clock, content, took=20 * US):
    """Publish like DDS: the stamp is taken during the call."""
    with echo_filter.publishing(content):
        clock.now += took // 2
        stamp = clock.now
        clock.now += took // 2
    return content, stamp


steps = st.lists(
    st.tuples(st.sampled_from(["own", "foreign", "during", "other"]), st.sampled_from([b"a", b"b"])),
    max_size=40,
)


@given(steps, st.randoms())
def test_what_passes_is_exactly_what_others_sent(script, order):
    clock = Clock()
    echo_filter = EchoFilter(same, same, capacity=1000, now=clock)
    arriving, foreign = [], Counter()
    for kind, content in script:
        if kind != "foreign":
            arriving.append(publish(echo_filter, clock, content))
        if kind == "during":  # another publisher sends the same in the same microsecond
            arriving.append((content, clock.now - 5 * US))
            foreign[content] += 1
        if kind == "other":  # or something else
            arriving.append((b"other", clock.now - 5 * US))
            foreign[b"other"] += 1
        if kind == "foreign":
            clock.now += 100 * US
            arriving.append((content, clock.now))
            foreign[content] += 1
        clock.now += 100 * US
    order.shuffle(arriving)
    passed = Counter(content for content, stamp in arriving if not echo_filter.is_echo(content, stamp))
    assert passed == foreign


@given(st.integers(1, 30))
def test_repeats_pass_even_when_our_own_echoes_were_lost(repeats):
    clock = Clock()
    echo_filter = EchoFilter(same, same, capacity=1000, now=clock)
    for _ in range(repeats):
        publish(echo_filter, clock, b"again")
        clock.now += 50 * US
        assert not echo_filter.is_echo(b"again", clock.now)


def test_an_echo_that_arrives_before_publish_returns_is_recognised():
    clock = Clock()
    echo_filter = EchoFilter(same, same, capacity=10, now=clock)
    with echo_filter.publishing(b"x"):
        assert echo_filter.is_echo(b"x", clock.now)
        assert not echo_filter.is_echo(b"x", clock.now)
