"""`within`: both edges of the time, both bounds of the band, after an event, never recorded."""

import pytest

SPEED = "truth/robot/linear_x"
BAND = {"conditions": [{"signal": SPEED, "low": 0.45, "high": 0.55, "name": "speed", "unit": "m/s"}], "seconds": 1.0}


def steps(*values):
    return {SPEED: list(values)}


@pytest.mark.parametrize(
    ("rows", "passed"),
    [
        ([(0, 0.0), (5.0, 0.5), (6.0, 0.0)], True),
        ([(0, 0.0), (5.01, 0.5)], False),
        ([(0, 0.5), (5.99, 0.0)], False),
        ([(0, 0.45), (5.5, 0.55)], True),
        ([(0, 0.449)], False),
        ([(0, 0.551)], False),
        ([], False),
    ],
)
def test_the_band_is_kept_for_the_whole_time(record, found, rows, passed):
    assert found("within", record(steps(*rows)), start=5.0, **BAND).passed is passed


def test_where_it_left_the_band_is_told(record, found):
    finding = found("within", record(steps((0, 0.5), (5.4, 0.6))), start=5.0, **BAND)
    assert finding.expected == "speed between 0.45 and 0.55 m/s from 5 s to 6 s"
    assert (finding.measured, finding.at_s, finding.timing) == ("speed was 0.60 m/s at 5.40 s", 5.4, True)
    assert not found("within", record(steps((0, 9.0))), start=5.0, **BAND).timing


def test_an_event_begins_it_and_settling_is_allowed(record, found):
    signals = steps((0, 0.0), (3.2, 0.5), (4.5, 0.0)) | {"topics/go/count": [(3.0, 1.0)]}
    after = {"after": {"topic": "/go"}}
    assert not found("within", record(signals), **after, **BAND).passed
    assert found("within", record(signals), settle=0.2, **after, **BAND).passed
    assert not found("within", record(signals), settle=0.6, **after, **BAND).passed
    silent = found("within", record(steps((0, 0.5))), **after, **BAND)
    assert (silent.passed, silent.measured) == (False, "this never happened: a message on /go")


def test_a_run_that_broke_off_keeps_no_band(record, found):
    finding = found("within", record(steps((0, 0.5)), facts={"sim_seconds": 5.5}), start=5.0, **BAND)
    assert (finding.passed, finding.measured) == (False, "the simulation ended at 5.50 s at 5.50 s")
