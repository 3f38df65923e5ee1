"""Wrong programs, one misconception each, answer the scans of a robot: the first sentence names the fault."""

import itertools
import math
import statistics

import numpy as np
import pytest

from gz_course.grader.feedback.predictions.answers import Asked, Scans, explain

LOW, HIGH, RAYS, COUNT = 0.12, 10.0, 180, 24
ANGLES = np.linspace(-math.pi, math.pi, RAYS)


class Scan:
    """What a node receives."""

    range_min, range_max, angle_min, angle_max = LOW, HIGH, -math.pi, math.pi
    angle_increment = 2 * math.pi / (RAYS - 1)

    def __init__(self, ranges):
        self.ranges = ranges


def _room(number):
    """Return the ranges in a long room with a pillar, as the robot drives along it and turns."""
    x, y, yaw = 0.5 + 0.035 * number, 0.4 * math.sin(number / 9), 0.01 * number
    with np.errstate(divide="ignore"):
        along = np.where(np.cos(ANGLES + yaw) > 0, (14.0 - x), (2.0 + x)) / np.abs(np.cos(ANGLES + yaw))
        across = np.where(np.sin(ANGLES + yaw) > 0, (2.3 - y), (1.9 + y)) / np.abs(np.sin(ANGLES + yaw))
    ranges = np.minimum(along, across) + 0.003 * np.sin(37.0 * ANGLES + number)
    ranges[100:115] = 0.7 + 0.3 * math.sin(number * 1.3) + 0.011 * number + 0.004 * np.arange(15)
    ranges[ranges > HIGH] = math.inf
    ranges[20:22] = -math.inf
    ranges[150:165] = math.inf
    return ranges.astype(np.float32).astype(float)


ROWS = [_room(number) for number in range(COUNT)]


def valid(scan):
    return [r for r in scan.ranges if scan.range_min < r < scan.range_max]


TRUTHS = {"minimum": min, "mean": statistics.fmean, "valid_count": len}
OF = {"minimum": lambda v: float(v.min()), "mean": lambda v: float(v.mean()), "valid_count": lambda v: float(len(v))}


def said_of(program, statistic, tolerance=None):
    return str(explained(program, statistic, tolerance))


def explained(program, statistic, tolerance=None):
    """Explain a program, a function of the scan and of what it keeps, that may answer None, or several numbers."""
    kept, given, last, number, spread = {}, [], [], [], []
    for row in ROWS:
        answer = program(Scan(list(row)), kept)
        several = answer if isinstance(answer, list) else [math.nan if answer is None else answer]
        given.append(several[0])
        last.append(several[-1])
        number.append(len(several))
        spread.append(float(max(several)) - float(min(several)))
    tolerance = tolerance or {"minimum": 0.001, "mean": 0.0101, "valid_count": 0.1}[statistic]
    every = np.ones(COUNT)
    return explain(
        Asked(
            statistic,
            np.arange(COUNT) / 10,
            np.array([float(TRUTHS[statistic](valid(Scan(row)))) for row in ROWS]),
            np.array(given, dtype=float),
            ~np.isnan(given),
            tolerance,
            OF[statistic],
            Scans(ROWS, LOW * every, HIGH * every, -math.pi * every, math.pi * every),
            np.array(last, dtype=float),
            np.array(number),
            np.array(spread),
        )
    )


def before(steps):
    def program(scan, kept):
        past = kept.setdefault("past", [])
        past.append(min(valid(scan)))
        return past[-1 - steps] if len(past) > steps else None

    return program


def smallest_so_far(scan, kept):
    kept["best"] = min(kept.get("best", math.inf), min(valid(scan)))
    return kept["best"]


def smallest_before(scan, kept):
    kept.setdefault("all", []).append(min(valid(scan)))
    return min(kept["all"][:-1], default=100.0)


def running_average(scan, kept):
    kept.setdefault("all", []).append(min(valid(scan)))
    return sum(kept["all"]) / len(kept["all"])


def average_of_everything(scan, kept):
    kept.setdefault("all", []).extend(valid(scan))
    return sum(kept["all"]) / len(kept["all"])


def low_pass(scan, kept):
    kept["value"] = 0.8 * kept.get("value", min(valid(scan))) + 0.2 * min(valid(scan))
    return kept["value"]


def median_of_five(scan, kept):
    kept.setdefault("last", []).append(min(valid(scan)))
    return statistics.median(kept["last"][-5:])


def first_only(scan, kept):
    return kept.setdefault("first", min(valid(scan)))


def counter(scan, kept):
    kept["n"] = kept.get("n", 0) + 1
    return kept["n"]


def every(steps):
    def program(scan, kept):
        kept["n"] = kept.get("n", -1) + 1
        return min(valid(scan)) if kept["n"] % steps == 0 else None

    return program


def once(scan, kept):
    kept["n"] = kept.get("n", 0) + 1
    return min(valid(scan)) if kept["n"] == 1 else None


def gives_up(scan, kept):
    kept["n"] = kept.get("n", 0) + 1
    return min(valid(scan)) if kept["n"] < 13 else None


def every_second_is_wrong(scan, kept):
    kept["n"] = kept.get("n", 0) + 1
    return min(valid(scan)) if kept["n"] % 2 else max(valid(scan))


def nearest(scan):
    return scan.ranges.index(min(valid(scan)))


def until_invalid(scan):
    """Return the ranges before the first invalid one."""
    return list(itertools.takewhile(lambda r: scan.range_min < r < scan.range_max, scan.ranges))


def halves(scan, kept):
    value = 0.0
    for each in valid(scan):
        value = (value + each) / 2
    return value


def x_of(scan, ray):
    return scan.ranges[ray] * math.cos(scan.angle_min + ray * scan.angle_increment)


MINIMA = {
    "before the first invalid one: a break": lambda scan, kept: min(until_invalid(scan)),
    "2 significant digits": lambda scan, kept: float(f"{min(valid(scan)):.1e}"),
    "x of the nearest point": lambda scan, kept: x_of(scan, nearest(scan)),
    "those of the scan before": before(1),
    "those of two scans before": before(2),
    "three to ten scans before": before(5),
    "the smallest of all scans so far": smallest_so_far,
    "the smallest of all scans before this one": smallest_before,
    "the average of all scans so far": running_average,
    "a low-pass filter": low_pass,
    "a median over the last 5 scans": median_of_five,
    "always that of the first scan": first_only,
    "a counter of the scans": counter,
    "always the same number": lambda scan, kept: 1.5,
    "0 in every scan": lambda scan, kept: 0.0,
    "the average of the valid ranges": lambda scan, kept: statistics.fmean(valid(scan)),
    "the largest valid range": lambda scan, kept: max(valid(scan)),
    "the sum of the valid ranges": lambda scan, kept: sum(valid(scan)),
    "the median of the valid ranges": lambda scan, kept: statistics.median(valid(scan)),
    "the number of valid rays": lambda scan, kept: len(valid(scan)),
    "the second smallest valid range": lambda scan, kept: sorted(valid(scan))[1],
    "the index of the nearest ray": lambda scan, kept: nearest(scan),
    "the index of the nearest among the valid": lambda scan, kept: int(np.argmin(valid(scan))),
    "the angle [rad] of the nearest ray": lambda scan, kept: scan.angle_min + nearest(scan) * scan.angle_increment,
    "nearest ray in degrees": lambda scan, kept: math.degrees(scan.angle_min + nearest(scan) * scan.angle_increment),
    "beside the nearest one": lambda scan, kept: scan.ranges[nearest(scan) + 1],
    "the first ray": lambda scan, kept: scan.ranges[0],
    "the last ray": lambda scan, kept: scan.ranges[-1],
    "the middle ray": lambda scan, kept: scan.ranges[len(scan.ranges) // 2],
    "the first half of the rays": lambda scan, kept: min(valid(Scan(scan.ranges[:90]))),
    "those of the rays ahead only, within 15 degrees of straight ahead": lambda scan, kept: min(
        valid(Scan(scan.ranges[82:98]))
    ),
    "all rays, the invalid ones": lambda scan, kept: min(scan.ranges),
    "range_min was not asked about": lambda scan, kept: min(r for r in scan.ranges if r < scan.range_max),
    "with 0 in place": lambda scan, kept: min(r if 0.12 < r < 10 else 0.0 for r in scan.ranges),
    "range_min, the limit": lambda scan, kept: scan.range_min,
    "clipped to range_min and range_max": lambda scan, kept: max(min(scan.ranges), scan.range_min),
    "rounded to two decimals": lambda scan, kept: round(min(valid(scan)), 2),
    "rounded to one decimal": lambda scan, kept: round(min(valid(scan)), 1),
    "whole numbers": lambda scan, kept: min(valid(scan)) // 1,
    "in millimetres": lambda scan, kept: 1000 * min(valid(scan)),
    "in centimetres": lambda scan, kept: 100 * min(valid(scan)),
    "half the right value": lambda scan, kept: min(valid(scan)) / 2,
    "twice the right value": lambda scan, kept: min(valid(scan)) * 2,
    "with the wrong sign": lambda scan, kept: -min(valid(scan)),
    "less range_min": lambda scan, kept: min(valid(scan)) - scan.range_min,
    "with the same number added": lambda scan, kept: min(valid(scan)) + 0.17,
    "times the same factor": lambda scan, kept: min(valid(scan)) * 0.9,
    "those of a part of the rays only, such as 25% of them from 25% on": lambda scan, kept: min(
        valid(Scan(scan.ranges[90 // 2 : 90]))
    ),
    "beyond 1 m, another bound": lambda scan, kept: min(r for r in scan.ranges if 1.0 < r < scan.range_max),
    "the reciprocal": lambda scan, kept: 1 / min(valid(scan)),
    "answered every second scan only": every(2),
    "answered one scan in 10 only": every(10),
    "answered the first scan only": once,
    "answered no scan after 1.10 s": gives_up,
    "your answers alternate": every_second_is_wrong,
}
MEANS = {
    "the smallest valid range": lambda scan, kept: min(valid(scan)),
    "the median of the valid ranges": lambda scan, kept: statistics.median(valid(scan)),
    "divided by the number of all rays": lambda scan, kept: sum(valid(scan)) / len(scan.ranges),
    "inf counted as range_max": lambda scan, kept: statistics.fmean(
        min(r, scan.range_max) for r in scan.ranges if r > scan.range_min
    ),
    "range_max was not asked about": lambda scan, kept: statistics.fmean(r for r in scan.ranges if r > scan.range_min),
    "with 0 in place": lambda scan, kept: statistics.fmean(r if 0.12 < r < 10 else 0.0 for r in scan.ranges),
    "bounds of the angles": lambda scan, kept: statistics.fmean(
        r for r in scan.ranges if scan.angle_min < r < scan.angle_max
    ),
    "of all valid ranges so far": average_of_everything,
    "every second ray": lambda scan, kept: statistics.fmean(valid(Scan(scan.ranges[::2]))),
    "the last ray": lambda scan, kept: scan.ranges[-1],
    "one ray too few or too many": lambda scan, kept: sum(valid(scan)) / (len(valid(scan)) - 1),
    "the middle between": lambda scan, kept: (min(valid(scan)) + max(valid(scan))) / 2,
    "the sum of the valid ranges": lambda scan, kept: sum(valid(scan)),
    "cut off after one decimal": lambda scan, kept: int(10 * statistics.fmean(valid(scan))) / 10,
}
COUNTS = {
    "those of all rays": lambda scan, kept: len(scan.ranges),
    "the number of rays that are not valid": lambda scan, kept: len(scan.ranges) - len(valid(scan)),
    "range_max was not asked about": lambda scan, kept: sum(r > scan.range_min for r in scan.ranges),
    "range_min was not asked about": lambda scan, kept: sum(r < scan.range_max for r in scan.ranges),
    "bounds of the angles": lambda scan, kept: sum(scan.angle_min < r < scan.angle_max for r in scan.ranges),
    "one less than the number": lambda scan, kept: len(valid(scan)) - 1,
    "one more than the number": lambda scan, kept: len(valid(scan)) + 1,
    "the sum over all scans so far": lambda scan, kept: (
        kept.__setitem__("n", kept.get("n", 0) + len(valid(scan))) or kept["n"]
    ),
    "the percentage of all rays": lambda scan, kept: 100 * len(valid(scan)) / len(scan.ranges),
    "the average of the valid ranges": lambda scan, kept: statistics.fmean(valid(scan)),
    "the first half of the rays": lambda scan, kept: len(valid(Scan(scan.ranges[:90]))),
}


@pytest.mark.parametrize("statistic", TRUTHS)
def test_every_misconception_is_named(statistic):
    programs = {"minimum": MINIMA, "mean": MEANS, "valid_count": COUNTS}[statistic]
    said = {words: said_of(program, statistic) for words, program in programs.items()}
    assert {words: sentence for words, sentence in said.items() if words not in sentence} == {}


@pytest.mark.parametrize("statistic", TRUTHS)
def test_a_right_program_and_noise_have_no_explanation(statistic):
    draw = np.random.default_rng(3)
    assert said_of(lambda scan, kept: TRUTHS[statistic](valid(scan)), statistic) == ""
    assert said_of(lambda scan, kept: draw.uniform(0.3, 3.0), statistic) == ""
    assert said_of(lambda scan, kept: None, statistic) == ""


def test_two_that_fit_are_both_named():
    still = np.full(12, 2.5)
    asked = Asked("minimum", np.arange(12.0), still, still * 0 + 5.0, still > 0, 0.001)
    assert str(explain(asked)) == "your answers are twice the right value"
    scans = Scans([np.array([5.0, 2.5, 5.0])] * 12, 0 * still, 0 * still + 10, 0 * still, 0 * still + 1)
    both = str(explain(Asked("minimum", np.arange(12.0), still, still * 0 + 5.0, still > 0, 0.001, scans=scans)))
    assert both.count(", or ") == 1


def test_hostile_answers_raise_nothing():
    for value in (math.inf, -math.inf, 1e300, -1e-300):
        assert isinstance(said_of(lambda scan, kept, value=value: value, "minimum"), str)
        assert isinstance(said_of(lambda scan, kept, value=value: value, "valid_count"), str)


def cut(limit):
    return lambda scan, kept: min(min(valid(scan)), limit)


def slowly(scan, kept):
    now = min(valid(scan))
    last = kept.get("last", now)
    kept["last"] = max(last - 0.1, min(last + 0.1, now))
    return kept["last"]


def from_scan(number, program):
    def late(scan, kept):
        kept["n"] = kept.get("n", -1) + 1
        return program(scan, kept) if kept["n"] >= number else min(valid(scan))

    return late


def groups(scan):
    """Return for each run of rays whether they are valid."""
    return [ok for ok, _ in itertools.groupby(scan.ranges, lambda r: scan.range_min < r < scan.range_max)]


def least_of_largest(scan, kept):
    kept["least"] = min(kept.get("least", math.inf), max(valid(scan)))
    return kept["least"]


FITTED = {
    "minimum": {
        "the root mean square": lambda scan, kept: math.sqrt(statistics.fmean(r * r for r in valid(scan))),
        "the harmonic mean": lambda scan, kept: statistics.harmonic_mean(valid(scan)),
        "the geometric mean": lambda scan, kept: statistics.geometric_mean(valid(scan)),
        "the variance": lambda scan, kept: statistics.pvariance(valid(scan)),
        "the 5th percentile": lambda scan, kept: float(np.percentile(valid(scan), 5)),
        "number 4 of the valid ranges": lambda scan, kept: sorted(valid(scan))[3],
        "the average of the 10 smallest": lambda scan, kept: statistics.fmean(sorted(valid(scan))[:10]),
        "rounded to multiples of 0.05": lambda scan, kept: round(min(valid(scan)) / 0.05) * 0.05,
        "changing by at most 0.1 ": slowly,
        "never above 0.75": cut(0.75),
        "never below 0.8": lambda scan, kept: max(min(valid(scan)), 0.8),
        "1.2 times the right value plus 0.3": lambda scan, kept: 1.2 * min(valid(scan)) + 0.3,
        "right until 1.20 s; from then on they are the largest valid range": from_scan(12, lambda s, k: max(valid(s))),
        "the difference between the largest and the smallest": lambda scan, kept: max(valid(scan)) - min(valid(scan)),
    },
    "mean": {
        "the root mean square": lambda scan, kept: math.sqrt(statistics.fmean(r * r for r in valid(scan))),
        "such as rays 33 to 76; a scan has 180": lambda scan, kept: statistics.fmean(valid(Scan(scan.ranges[33:77]))),
        "such as rays 150 to 29; a scan has 180": lambda scan, kept: statistics.fmean(
            valid(Scan(scan.ranges[150:] + scan.ranges[:30]))
        ),
        "the average, over all scans so far, of the smallest valid range": running_average,
        "those of the numbers of the valid rays": lambda scan, kept: statistics.fmean(
            i for i, r in enumerate(scan.ranges) if scan.range_min < r < scan.range_max
        ),
        "begins with the first valid range": lambda scan, kept: (sum(valid(scan)) + valid(scan)[0]) / len(valid(scan)),
        "cut to whole numbers first": lambda scan, kept: statistics.fmean(map(int, valid(scan))),
    },
    "valid_count": {
        "one less than the number of all rays": lambda scan, kept: len(scan.ranges) - 1,
        "below 5 m, -inf included": lambda scan, kept: sum(r < 5.0 for r in scan.ranges),
        "groups of valid rays": lambda scan, kept: sum(1 for group in groups(scan) if group),
        "the smallest, over all scans so far, of the largest valid range": least_of_largest,
        "those of a part of the rays only": lambda scan, kept: len(valid(Scan(scan.ranges[13:77]))),
        "one ray in 4 only": lambda scan, kept: len(valid(Scan(scan.ranges[::4]))),
    },
}


@pytest.mark.parametrize("statistic", TRUTHS)
def test_a_misconception_with_a_number_in_it_is_named_with_the_number(statistic):
    said = {words: said_of(program, statistic) for words, program in FITTED[statistic].items()}
    assert {words: sentence for words, sentence in said.items() if words not in sentence} == {}
