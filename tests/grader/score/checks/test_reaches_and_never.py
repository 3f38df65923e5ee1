"""`reaches` and `never`: at least once, and not once; each is the other's opposite."""

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

X = "truth/robot/x"
HIGH = {"signal": X, "low": 1.0, "name": "the gate"}


def test_once_is_enough_and_the_moment_is_told(record, found):
    finding = found("reaches", record({X: [(0, 0.0), (2.5, 1.0), (3, 0.0)]}), event=HIGH)
    assert (finding.passed, finding.measured, finding.at_s) == (True, "at 2.50 s", 2.5)
    assert finding.expected == "the gate, between 0 and 8 s"


def test_too_late_is_told_as_such(record, found):
    finding = found("reaches", record({X: [(0, 0.0), (2.5, 1.0)]}), event=HIGH, window=[0.0, 2.0])
    assert (finding.passed, finding.measured, finding.timing) == (False, "only at 2.50 s", True)


def test_never_tells_how_near_it_came(record, found):
    assert found("reaches", record({X: [(0, 0.0), (1, 0.7)]}), event=HIGH).measured.endswith("it came was 0.70")
    assert "nothing was recorded" in found("reaches", record(), event=HIGH).measured


def test_a_message_and_a_line_of_the_log_are_events(record, found):
    recording = record({"topics/done/count": [(3, 1.0)]}, lines=[(4, "[INFO] [n]: arrived at 3")])
    assert found("reaches", recording, event={"topic": "done"}).measured == "at 3.00 s"
    assert found("reaches", recording, event={"log": "^arrived"}).measured == "at 4.00 s"
    assert not found("reaches", recording, event={"log": "left"}).passed


def test_the_forbidden_moment_is_told(record, found):
    conditions = {"conditions": [{"signal": X, "low": 1.0, "name": "x", "unit": "m"}]}
    finding = found("never", record({X: [(0, 0.0), (2.5, 1.5), (3, 0.0)]}), **conditions)
    assert (finding.passed, finding.measured, finding.at_s) == (False, "x was 1.50 m at 2.50 s", 2.5)
    assert finding.expected == "never x at least 1 m"
    assert found("never", record({X: [(0, 0.0), (2.5, 1.5)]}), window=[0.0, 2.5], **conditions).passed


def test_all_conditions_must_hold_at_once(record, found):
    both = {"conditions": [{"signal": X, "low": 1.0}, {"signal": "truth/robot/y", "low": 1.0}]}
    apart = record({X: [(0, 2.0), (2, 0.0)], "truth/robot/y": [(0, 0.0), (2, 2.0)]})
    assert found("never", apart, **both).passed


def test_a_run_that_broke_off_proves_nothing(record, found):
    finding = found("never", record({X: [(0, 0.0)]}, facts={"sim_seconds": 3.0}), conditions=[HIGH])
    assert (finding.passed, finding.measured) == (False, "the simulation ended at 3.00 s")


@settings(deadline=None, max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.floats(-2, 2), min_size=1, max_size=10))
def test_what_is_reached_has_happened(record, found, values):
    recording = record({X: [(i * 0.5, value) for i, value in enumerate(values)]})
    reached = found("reaches", recording, event=HIGH).passed
    assert reached == (max(values) >= 1.0)
    assert found("never", recording, conditions=[HIGH]).passed is not reached
