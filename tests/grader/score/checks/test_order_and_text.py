"""`order` and `text`: what came first, and what was said."""

import pytest

from gz_course.grader.errors import ManifestError

X = "truth/robot/x"
EVENTS = [{"topic": "go"}, {"signal": X, "low": 1.0, "name": "the gate"}, {"log": "arrived", "name": "the word"}]


@pytest.mark.parametrize(
    ("go", "gate", "word", "passed"),
    [(1, 2, 3, True), (2, 2, 2, True), (2, 1, 3, False), (1, 3, 2, False), (3, 2, 1, False)],
)
def test_each_comes_after_the_one_before(record, found, go, gate, word, passed):
    signals = {"topics/go/count": [(go, 1.0)], X: [(0, 0.0), (gate, 1.0)]}
    finding = found("order", record(signals, lines=[(word, "[INFO] [n]: arrived")]), events=EVENTS)
    assert finding.passed is passed
    assert finding.expected == "a message on /go, then the gate, then the word"


def test_what_came_too_early_or_never_is_named(record, found):
    early = found("order", record({"topics/go/count": [(2, 1.0)], X: [(1, 1.0)]}), events=EVENTS)
    assert early.measured == "the gate at 1.00 s, before a message on /go at 2.00 s"
    never = found("order", record({"topics/go/count": [(2, 1.0)]}), events=EVENTS)
    assert never.measured == "this never happened: the gate after a message on /go at 2.00 s"


def test_only_the_first_time_counts_unless_after_says_otherwise(record, found):
    recording = record({"topics/go/count": [(2, 1.0)], X: [(1, 1.0), (1.5, 0.0), (3, 1.0)]})
    assert not found("order", recording, events=EVENTS[:2]).passed
    assert found("order", recording, events=[EVENTS[0], EVENTS[1] | {"after": 1.2}]).passed


@pytest.mark.parametrize(
    "events", [[], EVENTS[:1], [{"topic": "a", "log": "b"}, EVENTS[0]], [{"name": "x"}, EVENTS[0]]]
)
def test_events_that_are_none(record, found, events):
    with pytest.raises(ManifestError, match="check 'it'"):
        found("order", record(), events=events)


LINES = [(1, "[INFO] [n]: arrived at 3"), (2, "[WARN] [n]: arrived at 4"), (3, "arrived at 5"), (4, "[INFO] [n]: bye")]


def test_lines_of_the_logger_are_counted_and_printed_ones_are_not(record, found):
    recording = record(lines=LINES)
    assert found("text", recording, log="^arrived").measured == "2 of 3, the first at 1.00 s: 'arrived at 3'"
    assert found("text", recording, log="^arrived", count=[2, 2]).passed
    assert not found("text", recording, log="^arrived", count=[3]).passed
    assert not found("text", recording, log="^arrived", count=[0, 0]).passed
    assert "printed, not logged" in found("text", recording, log="5$").measured
    assert found("text", recording, log="gone").measured == "0 of 3; the last was 'bye'"


def test_where_the_exercise_s_own_node_plays_its_log_is_looked_at(record, found):
    recording = record(lines=LINES, log="log/given_node")
    assert found("text", recording, log="^arrived", count=[2, 2]).passed
    assert found("order", recording, events=[{"log": "arrived"}, {"log": "bye"}]).passed


def test_a_line_at_the_wrong_time_is_told(record, found):
    finding = found("text", record(lines=LINES), log="^bye", window=[0.0, 3.0])
    assert (finding.passed, finding.timing) == (False, True)
    assert finding.measured == "0 of 3; one at 4.00 s, not between 0 and 3 s"


def test_the_text_of_a_message(tmp_path, found):
    from gz_course.grader.record.reading import Recording
    from gz_course.grader.record.recorder import Recorder

    with Recorder(tmp_path / "run.rrd", "robot") as recorder:
        for at, said in ((1.0, "working"), (2.0, "done: 3"), (3.0, "done: 3")):
            recorder.set_time(round(at * 1e9))
            recorder.scalar("topics/state/count", 1.0)
            recorder.said("topics/state/data", said)
        recorder.properties("run", duration=8.0, facts="{}")
    recording = Recording(tmp_path / "run.rrd")
    assert found("text", recording, topic="/state", says="^done", count=[2, 2]).passed
    assert found("text", recording, topic="/state", says="^gone").measured == "0 of 3; the last was 'done: 3'"
    assert found(
        "order", recording, events=[{"topic": "state", "says": "^work"}, {"topic": "state", "says": "3"}]
    ).passed


def test_log_and_topic_exclude_each_other(record, found):
    for wrong in ({}, {"log": "x", "topic": "y", "says": "x"}):
        with pytest.raises(ManifestError, match=r"check 'it'.*log"):
            found("text", record(), **wrong)
