"""The clock is blamed only where the right thing happened at the wrong time, and where another clock is asked."""

import pytest

from gz_course.grader.kinds.kind import find_kind
from gz_course.grader.score.check import Finding
from gz_course.grader.score.clocks import clock_fault

LATE = Finding(False, "so", "not so", timing=True)
ASKED = {"wall_clock": [{"file": "node.py", "line": 7, "call": "time.time()", "waits": False}]}


def ends(*nodes, clock=True):
    found = [{"node": n, "kind": "publisher", "topic": "/cmd_vel", "type": "t"} for n in nodes]
    return found + [{"node": n, "kind": "subscription", "topic": "/clock", "type": "t"} for n in nodes if clock]


def test_the_place_is_told(record):
    assert clock_fault(record(facts=ASKED), [LATE]) == (
        "node.py, line 7: time.time() reads the wall clock, but time is simulated here: read the node's own "
        "clock, self.get_clock().now()."
    )
    sleeps = {"wall_clock": [ASKED["wall_clock"][0] | {"call": "time.sleep()", "waits": True}]}
    assert "time.sleep() waits by the wall clock" in clock_fault(record(facts=sleeps), [LATE])


def test_a_sleep_that_an_explanation_names_is_not_blamed_again(record):
    sleeps = {"wall_clock": [ASKED["wall_clock"][0] | {"call": "time.sleep()", "waits": True}]}
    explained = Finding(False, "so", "not so", timing=True, explanation="node.py, line 7: the sleep takes 2 s")
    assert clock_fault(record(facts=sleeps), [explained]) == ""
    other = Finding(False, "so", "not so", timing=True, explanation="node.py, line 77: the sleep takes 2 s")
    assert "line 7: time.sleep()" in clock_fault(record(facts=sleeps), [other])


@pytest.mark.parametrize(
    "finding",
    [
        Finding(False, "so", "not so"),
        Finding(True, "so", "so", timing=True),
        Finding(False, "so", "gated", timing=True, gated=True),
    ],
)
def test_who_failed_for_another_reason_is_not_told_of_clocks(record, finding):
    assert clock_fault(record(facts=ASKED | {"endpoints": ends("/n", clock=False)}), [finding]) == ""


def test_a_node_that_does_not_follow_the_clock(record):
    facts = {"endpoints": ends("/good") + ends("/bad", clock=False)}
    sentence = clock_fault(record(facts=facts), [LATE])
    assert "Your node /bad does not follow simulated time" in sentence and "use_sim_time" in sentence
    assert clock_fault(record(facts={"endpoints": ends("/good", "/too")}), [LATE]) == ""
    for kind in ("table", "bridge"):
        assert find_kind(kind).diagnosis().remarks == (), "it is not the student's"


def test_a_bridge_is_no_node_that_should_follow_the_clock(record):
    facts = {"endpoints": ends("/ros_gz_bridge", clock=False) + ends("/good")}
    assert "/ros_gz_bridge" in clock_fault(record(facts=facts), [LATE])
    started = {"launch": {"bridges_started": [{"node": "/ros_gz_bridge"}]}}
    assert clock_fault(record(facts=facts | started), [LATE]) == ""


def test_nothing_known_nothing_said(record):
    assert clock_fault(record(), [LATE]) == ""
