"""A message too late, or too many, is explained by the line that makes it so, and only by a line that would."""

import numpy as np
import pytest

from gz_course.grader.feedback.predictions.too_early_or_late import (
    added_up,
    answers_itself,
    counted_late,
    counted_too_far,
    sent_again,
    sent_too_early,
)

COUNTER = {"file": "n.py", "line": 4, "code": "self.n == 1", "counter": "self.n", "limit": 1.0, "added": 6}
WINDOW = (0.9, 1.6)


@pytest.mark.parametrize(("first", "limit", "named"), [(2.0, 1.0, True), (2.0, 3.0, False), (1.0, 1.0, False)])
def test_a_counter_that_is_looked_at_too_soon(record, first, limit, named):
    recording = record(facts={"counters": [COUNTER | {"limit": limit}]})
    said = counted_late(recording, np.array([first]), WINDOW)
    assert ("line 4: self.n == 1 is looked at before line 6 adds 1" in said) == named


@pytest.mark.parametrize(
    ("code", "number", "named"),
    [
        ("self.n > 1", 2, True),
        ("self.n > 1", 3, False),
        ("self.n == 1", 2, False),
        ("self.n >= 1", 2, False),
        ("self.n <= 1", 2, True),
    ],
)
def test_a_counter_that_lets_one_too_many_through(record, code, number, named):
    recording = record(facts={"counters": [COUNTER | {"code": code}]})
    said = counted_too_far(recording, np.arange(number) + 1.0)
    assert ("2 messages are sent" in said) == named


TIMER = {"file": "n.py", "line": 4, "kind": "timer", "seconds": 1.0, "rounds": 1}
SLEEP = TIMER | {"line": 7, "kind": "sleep"}


@pytest.mark.parametrize(
    ("delays", "first", "words"),
    [
        ([TIMER, SLEEP], 2.0, "line 4: the timer waits 1 s before its first call and the sleep in line 7 takes 1 s"),
        ([SLEEP | {"rounds": 2}], 2.0, "line 7: the sleep takes 1 s 2 times"),
        ([SLEEP | {"rounds": 2}, SLEEP | {"line": 9}], 2.0, "line 7: the sleep takes 1 s 2 times"),
        ([TIMER | {"seconds": 0.2}], 0.2, "line 4: the timer waits 0.2 s before its first call"),
        ([TIMER | {"seconds": 0.5}], 2.0, "calls every 0.5 s, and the message came in call 4"),
        ([TIMER, SLEEP], 1.0, ""),
        ([TIMER, SLEEP], 2.5, ""),
        ([], 2.0, ""),
    ],
)
def test_what_adds_up_to_the_time_of_the_message(record, delays, first, words):
    said = added_up(record(facts={"delays": delays}), np.array([first]), WINDOW)
    assert words in said and bool(said) == bool(words)


def test_a_timer_that_is_made_twice(record):
    place = {"file": "n.py", "line": 5, "said": "a second timer"}
    assert sent_again(record(facts={"repetitions": [place]})) == "n.py, line 5: a second timer"
    assert sent_again(record()) == ""


def test_a_message_before_anybody_listens(record):
    early = {"early_publishing": [{"file": "n.py", "line": 5, "function": "__init__"}]}
    assert "n.py, line 5: what is published here in __init__ is sent before" in sent_too_early(record(facts=early))
    assert sent_too_early(record()) == ""


@pytest.mark.parametrize(("number", "node", "named"), [(200, "/a", True), (3, "/a", False), (200, "/b", False)])
def test_a_node_that_answers_itself(record, number, node, named):
    ends = [{"topic": "/hello", "node": "/a", "kind": "publisher"}]
    ends.append({"topic": "/hello", "node": node, "kind": "subscription"})
    said = answers_itself(record(facts={"endpoints": ends}), "/hello", np.ones(number))
    assert ("your node subscribes to /hello" in said) == named
