"""`per_scan`: answers by log and by topic, right and wrong, and the rays on the limits."""

import math

import numpy as np
import pytest

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.score.checks.per_scan import per_scan as kind
from gz_course.grader.score.checks.per_scan import scans


def per_scan(recording, parameters):
    return kind(recording, Table(parameters, "check 'it'", "parameter"))


RANGES = [0.25, 1.0, 2.0, 10.0, math.inf, -math.inf, 0.1]
TIMES = [n / 10 for n in range(20)]
TOPIC = {"scan": "lidar/scan", "statistic": "minimum", "tolerance": 0.001, "signal": "topics/nearest/data"}
LOG = {"scan": "lidar/scan", "statistic": "mean", "tolerance": 0.0101, "log": r"avg=(\S+?)m$"}


@pytest.fixture
def scanned(record):
    """A recording of twenty scans with given ranges and what else was recorded."""

    def make(ranges=RANGES, signals=None, lines=(), low=0.25, high=10.0):
        limits = {f"topics/lidar/scan/range_{n}": [(t, v) for t in TIMES] for n, v in (("min", low), ("max", high))}
        arrays = {"topics/lidar/scan/ranges": [(t, ranges) for t in TIMES]}
        return record(limits | (signals or {}), arrays=arrays, lines=lines)

    return make


def answers(value, times=TIMES, delay=0.01):
    return {"topics/nearest/data": [(t + delay, value) for t in times]}


@pytest.mark.parametrize("answer", [1.0, 0.25, 1.0009, 0.9991])
def test_the_minimum_with_and_without_the_rays_on_the_limits(scanned, answer):
    finding = per_scan(scanned(signals=answers(answer)), TOPIC)
    assert (finding.passed, finding.measured, finding.at_s) == (True, "20 of 20 scans right", None)


@pytest.mark.parametrize("answer", [0.1, 1.0011, 0.9989, 2.0, -1.0])
def test_a_wrong_minimum(scanned, answer):
    finding = per_scan(scanned(signals=answers(answer)), TOPIC)
    assert (finding.passed, finding.at_s) == (False, 0.0)
    assert finding.measured.startswith(f"0 of 20 scans right; at 0.00 s it said {answer:g}, the truth was 1")


def test_answers_that_are_no_numbers_are_counted(scanned):
    signals = {f"{TOPIC['signal']}/not_finite": [(0.5, 1.0), (1.5, 1.0)]}
    finding = per_scan(scanned(signals=signals), TOPIC)
    assert finding.measured == "0 of 20 scans right, 20 without an answer; 2 answers were inf, -inf or nan"


@pytest.mark.parametrize(("statistic", "truths"), [("valid_count", (2, 4)), ("minimum", (1, 0.25)), ("mean", (1.5,))])
def test_the_statistics(scanned, statistic, truths):
    for truth in truths:
        assert per_scan(scanned(signals=answers(truth)), TOPIC | {"statistic": statistic}).passed


@pytest.mark.parametrize(("right", "passed"), [(20, True), (19, True), (18, False)])
def test_nineteen_of_twenty_are_enough(scanned, right, passed):
    finding = per_scan(scanned(signals=answers(1.0, TIMES[:right])), TOPIC)
    assert finding.passed is passed
    if right < 20:
        assert f"{20 - right} without an answer" in finding.measured
        assert passed or finding.at_s == TIMES[right]


def test_an_answer_belongs_to_the_scan_before_it(scanned):
    every = TOPIC | {"at_least": 1.0}
    assert per_scan(scanned(signals=answers(1.0, delay=0.0)), every).passed, "at the very moment of the scan"
    assert per_scan(scanned(signals=answers(1.0, delay=0.0999)), every).passed, "just before the next"
    late = {"topics/nearest/data": [(t + 0.1, 1.0) for t in TIMES[:-2]]}
    assert per_scan(scanned(signals=late), every).measured.startswith("18 of 20")


def test_every_answer_to_a_scan_counts(scanned):
    twice = {"topics/nearest/data": sorted((t + d, 1.0) for t in TIMES for d in (0.01, 0.02))}
    assert per_scan(scanned(signals=twice), TOPIC).passed, "the same once more is no fault"
    then = {"topics/nearest/data": sorted((t + d, v) for t in TIMES for d, v in ((0.01, 1.0), (0.02, 5.0)))}
    finding = per_scan(scanned(signals=then), TOPIC)
    assert not finding.passed and "it said 5" in finding.measured
    both = {"topics/nearest/data": sorted((t + d, v) for t in TIMES for d, v in ((0.01, 5.0), (0.02, 1.0)))}
    assert not per_scan(scanned(signals=both), TOPIC).passed


def test_no_answers_at_all(scanned):
    finding = per_scan(scanned(), TOPIC)
    assert (finding.passed, finding.measured) == (False, "0 of 20 scans right, 20 without an answer")


def test_without_scans_nothing_passes(record):
    assert not per_scan(record(answers(1.0)), TOPIC).passed


def test_scans_without_a_valid_ray_are_not_asked_about(scanned):
    finding = per_scan(scanned(ranges=[math.inf, -math.inf, math.nan, 0.1, 10.1]), TOPIC)
    assert (finding.passed, finding.measured) == (False, "0 of 0 scans right")


def logged(text, level="INFO"):
    return [(t + 0.01, f"[{level}] [listener]: {text}" if level else text) for t in TIMES]


def test_answers_in_the_log(scanned):
    assert per_scan(scanned(lines=logged("avg=1.50m")), LOG).passed
    assert per_scan(scanned(lines=logged("avg=1.51m", "WARN")), LOG).passed, "rounded, at any level"
    assert not per_scan(scanned(lines=logged("avg=1.52m")), LOG).passed
    assert not per_scan(scanned(lines=logged("avg=nanm")), LOG).passed
    assert not per_scan(scanned(lines=logged("avg=manym")), LOG).passed


def test_printed_answers_do_not_count_and_are_told_apart(scanned):
    finding = per_scan(scanned(lines=logged("avg=1.50m", None)), LOG)
    assert not finding.passed
    assert "20 such lines were printed, not logged" in finding.measured
    assert "get_logger" in finding.measured


def test_lines_that_do_not_match_are_no_answers(scanned):
    lines = sorted([*logged("starting"), *logged("avg=1.50m")])
    assert per_scan(scanned(lines=lines), LOG).passed


def test_a_limit_is_the_number_that_a_message_can_hold(record):
    """0.12 in a message is the float32 nearest to it, which is less than 0.12: a ray of that length is on the limit."""
    signals = {f"topics/lidar/scan/range_{n}": [(0, v)] for n, v in (("min", 0.12), ("max", 6.0))}
    near = float(np.float32(0.12))
    recording = record(signals, arrays={"topics/lidar/scan/ranges": [(0, [near, 1.0, 2.0])]})
    assert scans(recording, "lidar/scan", "minimum")[0].answers == (1.0, near)


def test_lines_of_another_form_are_quoted_and_not_taken_for_silence(scanned):
    finding = per_scan(scanned(lines=[(t + 0.01, "[INFO] [n]: avg = 1.50 metres") for t in TIMES]), LOG)
    assert not finding.passed
    assert finding.measured.endswith("no line of the log has the form that is asked for; one was 'avg = 1.50 metres'")
    assert "; nothing was logged: " in per_scan(scanned(), LOG).measured


def test_a_line_of_another_form_is_compared_with_an_example(scanned):
    finding = per_scan(scanned(lines=logged("avg: 1.50m")), LOG | {"line": "avg=4.56m"})
    assert finding.explanation.startswith("after 'avg' the line has ': N.NNm', where '=N.NNm' is asked for")
    assert per_scan(scanned(lines=logged("avg=1.50m")), LOG | {"line": "avg=4.56m"}).explanation == ""


def test_several_answers_to_a_scan_are_explained_as_such(scanned):
    several = [(t + 0.01 * n, value) for t in TIMES for n, value in enumerate((2.0, 1.5, 1.0), start=1)]
    finding = per_scan(scanned(signals={"topics/nearest/data": several}), TOPIC)
    assert finding.explanation.startswith("your node answers each scan about 3 times; only the last answer is right")


def test_a_log_that_nobody_gets_is_explained_by_the_file(record):
    signals = {f"topics/lidar/scan/range_{n}": [(t, v) for t in TIMES] for n, v in (("min", 0.2), ("max", 10.0))}
    arrays = {"topics/lidar/scan/ranges": [(t, RANGES) for t in TIMES]}
    recording = record(signals, arrays=arrays, facts={"silent_log": [{"line": 7, "said": "debug() is silent"}]})
    assert per_scan(recording, LOG).explanation == "line 7: debug() is silent"


def test_a_log_that_leaves_lines_out_is_explained_by_the_file(record):
    signals = {f"topics/lidar/scan/range_{n}": [(t, v) for t in TIMES] for n, v in (("min", 0.25), ("max", 10.0))}
    arrays = {"topics/lidar/scan/ranges": [(t, RANGES) for t in TIMES]}
    facts = {"seldom_log": [{"line": 7, "said": "once=True lets this line through once only"}]}
    line = logged("avg=1.50m")[0][1]

    def found(times):
        return per_scan(record(signals, arrays=arrays, lines=[(t + 0.01, line) for t in times], facts=facts), LOG)

    assert found(TIMES[::5]).explanation == "line 7: once=True lets this line through once only: 16 scans have no line"
    assert found(TIMES).passed
