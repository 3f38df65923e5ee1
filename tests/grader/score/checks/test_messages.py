"""`messages`: both bounds of the number, the window, the text."""

import pytest

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.record.reading import Recording
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.score.checks.messages import messages as kind

pytestmark = pytest.mark.usefixtures("without_blueprint")

ONCE = {"topic": "hello", "count": [1, 1]}


@pytest.fixture
def said(tmp_path):
    """A recording of texts on /hello: `said((1.0, "hello"), ...)`."""

    def make(*messages):
        with Recorder(tmp_path / "run.rrd", "robot") as recorder:
            recorder.properties("run", exercise="made")
            for at, text in messages:
                recorder.set_time(round(at * 1e9))
                recorder.scalar("topics/hello/count", 1.0)
                if text is not None:
                    recorder.said("topics/hello/data", text)
        return Recording(tmp_path / "run.rrd")

    return make


def found(recording, **parameters):
    table = Table(ONCE | parameters, "check 'it'", "parameter")
    finding = kind(recording, table)
    table.end()
    return finding


@pytest.mark.parametrize(
    ("number", "count", "passed"),
    [
        (0, [1, 1], False),
        (1, [1, 1], True),
        (2, [1, 1], False),
        (0, [1], False),
        (5, [1], True),
        (2, [2, 4], True),
        (4, [2, 4], True),
        (5, [2, 4], False),
        (0, [0, 0], True),
    ],
)
def test_the_number_must_lie_between_both_bounds(said, number, count, passed):
    recording = said(*((float(i), "hi") for i in range(number)))
    assert found(recording, count=count).passed is passed


def test_too_many_are_told_with_their_times_and_shown_at_the_first_too_many(said):
    finding = found(said((1.0, "a"), (2.0, "a"), (3.5, "a")))
    assert finding.expected == "exactly one message on /hello"
    assert finding.measured == "3 messages arrived, the first at 1.00 s, the last at 3.50 s"
    assert finding.at_s == 2.0


@pytest.mark.parametrize(("at", "passed"), [(0.89, False), (0.9, True), (3.0, True), (3.01, False)])
def test_only_the_window_counts(said, at, passed):
    finding = found(said((at, "hi")), window=[0.9, 3.0])
    assert finding.passed is passed
    assert finding.measured == f"1 message arrived, at {at:.2f} s"
    assert finding.expected == "exactly one message on /hello between 0.9 and 3 s"


@pytest.mark.parametrize(("text", "passed"), [("hello", True), ("Hello", False), ("hello ", False), (None, False)])
def test_only_the_very_text_counts(said, text, passed):
    assert found(said((1.0, text)), says="hello").passed is passed


def test_a_text_that_did_not_change_still_counts(said):
    recording = said((1.0, "no"), (2.0, "hello"), (3.0, "hello"))
    assert found(recording, says="hello", count=[2, 2]).passed
    assert not found(recording, says="hello", count=[3]).passed


def test_the_wrong_text_is_quoted(said):
    finding = found(said((1.0, "Hello\x1b[31m" + "x" * 100)), says="hello")
    assert finding.expected == "exactly one message on /hello saying 'hello'"
    assert "it said 'Hello\ufffd[31mxxx" in finding.measured and len(finding.measured) < 130
    assert found(said((1.0, None)), says="hello").measured.endswith("it said something other than a text")


def test_nothing_at_all(said):
    assert found(said()).measured == "no message arrived"


@pytest.mark.parametrize("wrong", [{"count": []}, {"count": ["1"]}, {"window": [1]}, {"says": ""}, {"topics": "x"}])
def test_an_author_s_mistake_is_told(said, wrong):
    with pytest.raises(ManifestError, match="check 'it'"):
        found(said((1.0, "hi")), **wrong)


def test_a_message_that_was_lost_has_been_sent(record, found):
    recording = record({"topics/hello/count": [(1.0, 1.0)]}, facts={"too_early": {"/hello": 1}})
    finding = found("messages", recording, topic="hello", count=[1, 1])
    assert not finding.passed and "1 more was sent before anybody had found the publisher" in finding.measured
    assert found("messages", recording, topic="hello", count=[1]).passed
