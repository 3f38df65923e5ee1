"""`count` and `rate`: numbers of messages, in bands and in simulated time."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

X = "topics/cmd_vel/linear/x"
COUNT = "topics/cmd_vel/count"


@pytest.mark.parametrize(
    ("count", "passed"), [([3], True), ([4], False), ([0, 3], True), ([0, 2], False), ([3, 3], True)]
)
def test_the_number_in_the_band(record, found, count, passed):
    recording = record({X: [(1, 0.5), (2, 0.45), (3, 0.55), (4, 0.56), (5, -1.0)]})
    finding = found("count", recording, signal=X, low=0.45, high=0.55, count=count)
    assert finding.passed is passed
    assert finding.measured.startswith("3 of 5")
    assert ("mostly -0.22" in finding.measured) is not passed


def test_only_the_window_counts(record, found):
    recording = record({X: [(1, 0.5), (2, 0.5), (3, 0.5)]})
    assert found("count", recording, signal=X, count=[2, 2], window=[1.5, 3.0]).passed
    assert found("count", recording, signal=X, count=[1], window=[4.0, 5.0]).measured == "nothing was recorded on it"


def every(seconds, until=8.0):
    return {COUNT: [(round(i * seconds, 6), 1.0) for i in range(int(until / seconds))]}


@pytest.mark.parametrize(("seconds", "passed"), [(0.1, True), (0.05, False), (0.2, False)])
def test_the_rate_is_in_simulated_time(record, found, seconds, passed):
    finding = found("rate", record(every(seconds)), topic="/cmd_vel", hertz=[9.0, 11.0])
    assert finding.passed is passed
    assert finding.measured.startswith(f"{1 / seconds:.2f} messages a simulated second")
    assert finding.expected == "9 to 11 messages a simulated second on /cmd_vel"


def test_a_gap_is_told_also_at_the_end(record, found):
    short = record(every(0.1, until=7.0))
    assert found("rate", short, topic="cmd_vel", hertz=[8.0]).passed
    finding = found("rate", short, topic="cmd_vel", hertz=[8.0], longest_gap=0.3)
    assert not finding.passed
    assert "the longest gap was 1.10 s, from 6.90 s on" in finding.measured and finding.at_s == 6.9


def test_silence_has_no_rate(record, found):
    finding = found("rate", record(), topic="cmd_vel", hertz=[0.0])
    assert (finding.passed, finding.measured) == (False, "no message arrived between 0 and 8 s")


@settings(deadline=None, max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.floats(0, 8), min_size=1, max_size=30, unique=True))
def test_the_rate_is_the_number_over_the_time(record, found, times):
    recording = record({COUNT: [(time, 1.0) for time in sorted(times)]})
    number = len({round(time * 1e9) for time in times})
    exact = len(times) / 8
    assert found("rate", recording, topic="cmd_vel", hertz=[exact - 1e-9, exact + 1e-9]).passed or number != len(times)
    assert not found("rate", recording, topic="cmd_vel", hertz=[exact + 0.1]).passed


@pytest.mark.parametrize(("scans", "words"), [(0.2, "one in 10 calls of on_scan publish, so a message"), (0.5, "")])
def test_a_counter_that_lets_few_messages_through_is_named_if_they_come_so(record, found, scans, words):
    said = {"line": 6, "about": "every", "said": "self.n % 10 == 0 lets only one in 10 calls of on_scan publish"}
    signals = every(2.0) | {"topics/scan/range_min": [(round(i * scans, 6), 0.1) for i in range(int(8 / scans))]}
    finding = found("rate", record(signals, facts={"suspects": [said]}), topic="cmd_vel", hertz=[0.95])
    assert words in finding.explanation if words else finding.explanation == ""


PLACES = [
    {"line": 5, "topic": "/cmd_vel", "said": "send() is called only while `self.idle` holds"},
    {"line": 3, "topic": "/cmd_vel", "said": "create_timer(2.0, self.send) publishes once in 2 s", "period": 2.0},
]


@pytest.mark.parametrize(
    ("times", "words"),
    [
        ([0.5 * i for i in range(16)], ""),
        ([2.0 * i for i in range(4)], "line 3: create_timer(2.0, self.send) publishes once in 2 s"),
        ([0.0, 0.2, 0.4, 0.6, 4.0, 4.2, 4.4, 7.8], "line 5: send() is called only while `self.idle` holds, so no"),
        ([1.5 * i for i in range(5)], ""),
    ],
)
def test_what_makes_messages_rare_is_named_if_they_come_in_that_rhythm(record, found, times, words):
    recording = record({COUNT: [(time, 1.0) for time in times]}, facts={"rhythm": PLACES})
    finding = found("rate", recording, topic="cmd_vel", hertz=[0.95], longest_gap=1.2)
    assert finding.explanation.startswith(words) and bool(finding.explanation) == bool(words)
