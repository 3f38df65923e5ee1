"""Which questions were answered at all."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from gz_course.grader.feedback.predictions.answers import Asked, notices


@notices
def only_the_first(asked: Asked) -> str:
    answered = np.flatnonzero(asked.answered)
    if len(answered) != 1 or len(asked.answered) < 3:
        return ""
    which = {0: "the first scan", len(asked.answered) - 1: "the last scan"}.get(int(answered[0]), "one scan")
    return f"your node answered {which} only: answer in every callback of the subscription"


OF = {"minimum": "nearest distance", "mean": "average", "valid_count": "number of valid rays"}
# What a scan may hold, for which a program skips it -> whether a row of ranges has it.
SKIPPED: dict[str, Callable[[np.ndarray, float, float], bool]] = {
    "in which a ray is -inf": lambda row, low, high: bool(np.isneginf(row).any()),
    "in which a ray is inf": lambda row, low, high: bool(np.isposinf(row).any()),
    "in which a ray is inf or -inf": lambda row, low, high: bool(np.isinf(row).any()),
    "in which a ray is nan": lambda row, low, high: bool(np.isnan(row).any()),
    "whose first ray is not valid": lambda row, low, high: not low < row[0] < high,
    "whose last ray is not valid": lambda row, low, high: not low < row[-1] < high,
    "whose middle ray, the one straight ahead, is not valid": lambda row, low, high: (
        not low < row[len(row) // 2] < high
    ),
}


@notices
def several_answers(asked: Asked) -> str:
    """Find programs that answer within the loop over the rays."""
    if asked.number is None or asked.last is None or asked.spread is None or asked.answered.sum() < 3:
        return ""
    number = asked.number[asked.answered]
    with np.errstate(invalid="ignore"):
        right = np.abs(asked.last - asked.truth)[asked.answered] <= asked.tolerance
    if np.mean(asked.spread[asked.answered] > asked.tolerance) <= 0.5:
        return ""
    often = f"about {np.median(number):.0f} times"
    for words, count in (("once for every valid ray", len), ("once for every ray", None)):
        rays = asked.of_rows(len) if count is None else asked.of_valid(count)
        if np.mean(np.abs(rays[asked.answered] - number) <= 1) >= 0.9 and np.median(number) > 5:
            often = words
    only = "only the last answer is right: " if right.mean() >= 0.9 else ""
    return f"your node answers each scan {often}; {only}one answer belongs after the loop over the rays, not in it"


@notices
def within_a_limit(asked: Asked) -> str:
    """Find answers that come only while the right value is below, or above, a limit."""
    there = asked.answered
    if min(there.sum(), (~there).sum()) < 3 or np.sum(there[1:] != there[:-1]) < 2:
        return ""
    for side, inside, outside in (("below", there, ~there), ("above", ~there, there)):
        low, high = asked.truth[inside].max(), asked.truth[outside].min()
        if low < high:
            limit = f"{(low + high) / 2:.3g}"
            return (
                f"your node answers only while the {OF.get(asked.statistic, 'value')} is {side} about {limit}: "
                "each scan needs an answer"
            )
    return ""


@notices
def skips_scans(asked: Asked) -> str:
    """Find answers that come only for scans without some kind of ray."""
    if asked.scans is None or min(asked.answered.sum(), (~asked.answered).sum()) < 3:
        return ""
    scans = asked.scans
    for words, has in SKIPPED.items():
        with_it = np.array(
            [has(row, low, high) for row, low, high in zip(scans.rows, scans.low, scans.high, strict=True)]
        )
        if np.mean(with_it == ~asked.answered) >= 0.97:
            return f"your node answers no scan {words}: leave such rays out, and answer the scan"
    return ""


@notices
def only_records(asked: Asked) -> str:
    """Find answers that come only if the right value is smaller, or larger, than ever before."""
    if min(asked.answered.sum(), (~asked.answered).sum()) < 3:
        return ""
    for words, sign in (("smaller", 1.0), ("larger", -1.0)):
        best = np.minimum.accumulate(sign * asked.truth)
        record = np.append(True, sign * asked.truth[1:] < best[:-1])
        since_the_last = np.append(True, sign * np.diff(asked.truth) < 0)
        for mask, than in ((record, "every one before"), (since_the_last, "the one before")):
            if np.mean(mask == asked.answered) >= 0.97:
                return f"your node answers only when the value is {words} than {than}: each scan needs an answer"
    return ""


@notices
def stopped_answering(asked: Asked) -> str:
    answered = np.flatnonzero(asked.answered)
    if len(answered) < 2 or answered[-1] - answered[0] + 1 != len(answered):
        return ""
    if answered[-1] < len(asked.answered) - max(2, 0.05 * len(asked.answered)):
        at = asked.times[answered[-1]]
        return f"your node answered no scan after {at:.2f} s: something ended the answers there"
    if answered[0] > max(1, 0.05 * len(asked.answered)):
        return f"your node did not answer before {asked.times[answered[0]]:.2f} s: it listens from then on only"
    return ""


@notices
def every_nth(asked: Asked) -> str:
    answered = np.flatnonzero(asked.answered)
    steps = np.diff(answered)
    if len(steps) > 5 and np.ptp(steps) == 1 and steps.mean() >= 1.3 and np.mean(steps == np.median(steps)) < 0.8:
        period = float(np.diff(asked.times[answered[[0, -1]]])[0] / len(steps))
        return (
            f"your node answers at even intervals of about {period:.2g} s, as a timer does, and not once for each "
            "scan: publish and log in the callback of the scan"
        )
    if len(steps) < 2 or np.median(steps) < 2 or np.mean(steps == np.median(steps)) < 0.8:
        return ""
    step = int(np.median(steps))
    which = {2: "every second scan", 3: "every third scan"}.get(step, f"one scan in {step}")
    period = float(np.median(np.diff(asked.times[answered])))
    return f"your node answered {which} only, once in {period:.2g} s: publish and log in the callback of each scan"


@notices
def only_changes(asked: Asked) -> str:
    """Find answers that come only if the value differs enough from the last one that was given."""
    known = np.flatnonzero(asked.answered)
    if len(known) < 4 or asked.answered.mean() > 0.95 or every_nth(asked) or stopped_answering(asked):
        return ""
    with np.errstate(invalid="ignore"):
        if not np.all(np.abs(asked.given[known] - asked.truth[known]) <= asked.tolerance):
            return ""
    last = known[np.searchsorted(known, np.arange(len(asked.truth)), side="left").clip(1) - 1]
    steps = np.abs(asked.truth - asked.truth[last])[known[0] + 1 :]
    there = asked.answered[known[0] + 1 :]
    missing = int(np.sum(~asked.answered))
    if not there.any() or there.all() or steps[~there].max() > steps[there].min() + asked.tolerance:
        return f"all your answers are right, but {missing} scans have none: something skips them"
    least = steps[there].min()
    return (
        f"your node answers only when the value has changed, by {least:.2g} or more: {missing} scans have no answer, "
        "and each needs one"
    )


@notices
def alternates(asked: Asked) -> str:
    known = asked.answered & np.isfinite(asked.given)
    with np.errstate(invalid="ignore"):
        right = np.abs(asked.given - asked.truth) <= asked.tolerance
    if not known.all() or len(right) < 6 or not 0.4 <= right.mean() <= 0.6:
        return ""
    if np.mean(right[1:] != right[:-1]) < 0.9:
        return ""
    return "your answers alternate: every second one is right, the others are not"
