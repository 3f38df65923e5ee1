"""Which distance and which bearing a node steers by, found out by fitting the usual law: `misconceptions.py` asks.

The law is angular.z = limited(h * heading + d * limited(distance - wanted)); the gains and the inner limit are fitted.
Each candidate is a distance, a heading, or directions of rays, as a program with one mistake takes them from the scan.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

LIMIT = 1.5  # [rad/s]
SCANS, FEWEST = 60, 15  # scans, and those of them in which angular.z is not at its limit
INNER = (0.15, 0.25, 0.35, 0.5, 0.8, 20.0)  # [m] limits of the error of the distance
THICK = 0.04  # [m] ranges that are as near as the nearest one, with noise
SIDES = ((-0.2, 2.5), (-0.15, 2.5), (0.0, 2.5), (0.0, 3.14), (-0.5, 2.4))  # [rad] from ahead towards the side
NARROW = ((0.52, 2.5), (0.7, 2.5), (0.79, 2.36), (1.05, 2.1), (1.22, 1.92))  # [rad] sectors that miss a wall ahead
SECTORS = ((30, 150), (45, 135), (60, 120), (0, 180), (75, 105))  # [degrees] of means
LEAST, SURE = 0.87, 0.95  # share that a mistake explains at least, and that the right law explains at most
LIKE_RIGHT = 0.9  # share that is explained if the law is the right one
EXACT = 0.98  # share that an unlikely mistake must explain
EVEN = 0.01  # [m] changes of a distance below it are none
BETTER = 0.4  # of what the right law leaves unexplained
RIGHT = "take the range of the nearest point itself"
NEAREST = "the distance from a wall is that of its nearest point, min(...) of the ranges on that side"


def nearest(
    bearings: np.ndarray, ranges: np.ndarray, side: tuple[float, float]
) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Return the nearest range, its bearing, the mean bearing of all that are as near, and that of the first one."""
    chosen = (bearings > side[0]) & (bearings < side[1])
    where = bearings[chosen]
    if not chosen.any():
        return np.full(len(ranges), np.inf), (np.zeros(len(ranges)),) * 3
    least = ranges[:, chosen].min(axis=1)
    there = ranges[:, chosen] < least[:, None] + THICK
    mean = (there * where).sum(axis=1) / np.maximum(there.sum(axis=1), 1)
    return least, (where[ranges[:, chosen].argmin(axis=1)], mean, where[there.argmax(axis=1)])


def distances(
    bearings: np.ndarray, ranges: np.ndarray, side: tuple[float, float]
) -> Iterator[tuple[str, str, np.ndarray]]:
    """Yield which function a mistake needs, words on a distance that is not the nearest range, and its values (n,)."""
    least, known = nearest(bearings, ranges, side)
    for bearing in known:
        ahead = "the nearest range times the cosine of its bearing, which is how far ahead it lies, not how far away"
        yield "cos", f"{ahead}; {RIGHT}", least * np.cos(bearing)
        yield "cos", f"{ahead}; {RIGHT}", least * np.abs(np.cos(bearing))
        across = "the nearest range times the sine of its bearing, which is less unless the wall is abeam"
        yield "sin", f"{across}; {RIGHT}", least * np.sin(bearing)
    chosen = (bearings > side[0]) & (bearings < side[1])
    where, part = bearings[chosen], np.where(np.isfinite(ranges[:, chosen]), ranges[:, chosen], np.nan)
    ahead, across = part * np.cos(where), part * np.sin(where)
    said = "the smallest r * cos(bearing) of the rays, which is how far ahead a point lies, not how far away"
    yield "cos", f"{said}; {RIGHT}", _least(np.abs(ahead))
    yield "cos", f"{said}; {RIGHT}", _least(ahead)
    said = "the smallest r * sin(bearing) of the rays: it is nearly 0 for whatever is ahead or behind"
    yield "sin", f"{said}; {RIGHT}", _least(across)
    yield "sin", f"{said}; {RIGHT}", _least(np.abs(across))
    yield "max", f"the farthest of the ranges on that side; {NEAREST}", np.nan_to_num(-_least(-part), nan=0.0)
    for low, high in SECTORS:
        inside = (where >= np.radians(low)) & (where <= np.radians(high))
        for name, of in (("mean", np.mean), ("median", np.median)):
            said = f"a {name} of the ranges on that side, which is larger, because slanted rays are longer; {NEAREST}"
            yield "mean", said, _of_hits(of, part[:, inside])
        said = f"a mean of r * sin(bearing) of the rays on that side, of all that they see there; {NEAREST}"
        yield "mean", said, _of_hits(np.mean, across[:, inside])


def _least(values: np.ndarray) -> np.ndarray:
    return np.where(np.isnan(values), 9.0, values).min(axis=1, initial=9.0)


def _of_hits(of: Any, values: np.ndarray) -> np.ndarray:
    """Return the mean or the median of each row's hits, (n,)."""
    return np.array([of(row[~np.isnan(row)]) if (~np.isnan(row)).any() else 9.0 for row in values])


def headings(bearings: np.ndarray, ranges: np.ndarray, side: tuple[float, float]) -> Iterator[tuple[str, np.ndarray]]:
    """Yield words on a heading that is not the bearing of the nearest point minus pi/2, with its values (n,)."""
    chosen = (bearings > side[0]) & (bearings < side[1])
    hits = np.isfinite(ranges)
    yield (
        "is that of the farthest range on that side: take that of the nearest one",
        bearings[chosen][np.where(hits, ranges, 0.0)[:, chosen].argmax(axis=1)] - np.pi / 2,
    )
    for bearing in nearest(bearings, ranges, side)[1]:
        yield "is its angle from abeam, not from ahead: a bearing is atan2(y, x), and x points ahead", -bearing
    for listed in (chosen & hits, hits, np.broadcast_to(chosen, hits.shape)):
        there = np.where(listed & chosen, ranges, np.inf).argmin(axis=1)
        number = np.take_along_axis(np.cumsum(listed, axis=1), there[:, None], axis=1)[:, 0] - 1
        if (number == there).mean() < 0.8:
            yield (
                "is made of its place in the list of rays that were chosen, as if that were the number of a ray: what "
                "is left out moves the others up, so keep the bearing of each ray beside its range",
                bearings[0] + number * (bearings[1] - bearings[0]) - np.pi / 2,
            )


def averages(least: np.ndarray) -> Iterator[tuple[np.ndarray, str]]:
    """Yield means and medians of the nearest range over time, with words on those that never end."""
    least = np.minimum(least, 9.0)
    medians = np.array([np.median(least[: i + 1]) for i in range(len(least))])
    sums = np.cumsum(least)
    said = "the distance that your node steers by is a {} of all scans since the start, which hardly changes in time"
    yield medians, f"{said.format('median')}: take the nearest range of this scan"
    yield sums / np.arange(1, len(least) + 1), f"{said.format('mean')}: take the nearest range of this scan"
    for number in (5, 10, 20, 40):
        before = np.concatenate([np.zeros(min(number, len(sums))), sums[:-number]])
        yield (sums - before) / np.minimum(np.arange(1, len(least) + 1), number), ""


def directions(bearings: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    """Yield words on directions that are counted another way, with the bearing that each ray is taken to have."""
    step = bearings[1] - bearings[0]
    way, number = np.sign(step), np.arange(len(bearings))
    rule = f"ray i looks to angle_min + i * angle_increment, and angle_min is {way * bearings[0]:.2f} rad"
    axes = "with x and y exchanged: x, which points ahead, is r * cos(angle), and y, to the left, is r * sin(angle)"
    yield axes, way * np.pi / 2 - bearings
    yield f"the other way round: {rule}", -bearings
    yield f"as if ray 0 looked ahead: {rule}", number * step
    yield f"as if ray 0 looked to the right: {rule}", number * step - way * np.pi / 2
    if abs(np.degrees(abs(step)) - 1) > 0.03:
        for first in (0, -90, -180):
            yield (
                f"as if ray i looked to i{first or ''} degrees: {rule}, one step is {abs(step):.3f} rad",
                way * np.radians(number + first),
            )


def law(distance: np.ndarray, heading: np.ndarray, rates: np.ndarray, asked: np.ndarray, turned: float = 0.0) -> float:
    """Return which share of the variance of turning rates [rad/s] the law explains, with the best gains.

    `turned` is the sign that the gain of the heading must have; 0 for any.
    """
    free, best = np.abs(rates) < 0.95 * LIMIT, 0.0
    for inner in INNER:
        terms = np.stack([np.clip(distance - asked, -inner, inner), heading], axis=1)
        gains = np.linalg.lstsq(terms[free], rates[free], rcond=None)[0]
        if gains[0] < 0.3 or gains[1] * turned < -0.3 or terms[:, 0].std() < EVEN:
            continue
        left = rates - np.clip(terms @ gains, -LIMIT, LIMIT)
        best = max(best, 1 - float((left**2).mean()) / max(rates.var(), 1e-9))
    return best


def errors(least: np.ndarray, heading: np.ndarray, asked: np.ndarray, rates: np.ndarray) -> Iterator[tuple[float, str]]:
    """Yield how well a wrong error of the distance explains the rates, with words: of one sign, or its change alone."""
    error = least - asked
    for sign, found in ((1, "above 0 all the time, also where the robot is too near"),
                        (-1, "below 0 all the time, also where the robot is too far")):  # fmt: skip
        share, gains = _linear(np.ones(len(rates)), heading, rates)
        if (sign * error < -0.05).sum() >= 10 and sign * gains[0] > 0.2:
            right = "it is the range of the nearest point minus the parameter distance"
            yield share, f"the error of the distance, as your node has it, is {found}: {right}"
    if error.std() < 0.05:
        return
    share, gains = _linear(np.zeros(len(rates)), heading, rates)
    if gains[1] > 0.3:
        yield (
            share,
            "angular.z follows the bearing of the nearest point alone: by how far it is away counts for nothing",
        )
    share, gains = _linear(np.diff(least, prepend=least[:1]), heading, rates)
    if gains[0] > 3:
        yield (
            share,
            (
                "angular.z answers the change of the distance from scan to scan, not by how much it is wrong: feed "
                "back the range minus the parameter distance, too"
            ),
        )


def _linear(first: np.ndarray, second: np.ndarray, rates: np.ndarray) -> tuple[float, np.ndarray]:
    """Return which share of the rates a limited sum of two terms explains, and the gains."""
    free, terms = np.abs(rates) < 0.95 * LIMIT, np.stack([first, second], axis=1)
    gains = np.linalg.lstsq(terms[free], rates[free], rcond=None)[0]
    left = rates - np.clip(terms @ gains, -LIMIT, LIMIT)
    return 1 - float((left**2).mean()) / max(rates.var(), 1e-9), gains


def best_right(bearings: np.ndarray, ranges: np.ndarray, rates: np.ndarray, asked: np.ndarray) -> float:
    """Return how much of the rates follows from the nearest point, whatever the signs are."""
    best = 0.0
    for side in SIDES:
        least, known = nearest(bearings, ranges, side)
        for heading in (*(bearing - np.pi / 2 for bearing in known), np.zeros(len(rates))):
            best = max(best, law(least, heading, rates, asked), law(least, heading, -rates, asked))
    return best


def signs(bearings: np.ndarray, ranges: np.ndarray, rates: np.ndarray, asked: np.ndarray, side: str) -> str:
    """Return which of the two terms has the wrong sign, if the law fits with that sign and not without."""
    free = np.abs(rates) < 0.95 * LIMIT
    if len(rates) < SCANS or free.sum() < FEWEST or rates[free].var() < 0.005:
        return ""
    ranges = np.where(np.isfinite(ranges) & (ranges > 0.05), ranges, np.inf)
    found: dict[str, float] = {}
    for limits in SIDES:
        least, known = nearest(bearings, ranges, limits)
        for heading in (bearing - np.pi / 2 for bearing in known):
            for name, given, turned in (("", rates, 1.0), ("heading", rates, -1.0), ("distance", -rates, -1.0)):
                found[name] = max(found.get(name, 0.0), law(least, heading, given, asked, turned))
    name = max(("heading", "distance"), key=found.__getitem__)
    if found[name] < LEAST or 1 - found[name] > BETTER * (1 - found[""]):
        return ""
    if name == "distance":
        return (
            f"the distance is fed back with the wrong sign: where the robot is too far from its wall ({side}), it "
            "turns away from it, and where it is too near, towards it"
        )
    return (
        "the heading is fed back with the wrong sign: where the nearest point of the wall is ahead of abeam, the robot "
        "must turn away from the wall, and it turns towards it"
    )


def best_wrong(
    bearings: np.ndarray, ranges: np.ndarray, rates: np.ndarray, asked: np.ndarray, kinds: Sequence[str]
) -> tuple[float, str]:
    """Return how much of the rates the best of the mistakes of these kinds explains, and words on it."""
    found = [(0.0, "")]
    least, known = nearest(bearings, ranges, SIDES[0])
    for distance, words in averages(least):
        if "mean" in kinds:
            shares = [law(distance, bearing - np.pi / 2, rates, asked) for bearing in known]
            found += [(share, words) for share in shares if share > SURE or not words]
    for low, high in NARROW:
        least, known = nearest(bearings, ranges, (low, high))
        words = (
            f"the nearest point that your node steers by is that of the rays from about {np.degrees(low):.0f} to "
            f"{np.degrees(high):.0f} degrees, counted from ahead to the side: what is ahead of them is not seen until "
            "the robot is beside it"
        )
        found += [(law(least, bearing - np.pi / 2, rates, asked), words) for bearing in known]
    for side in SIDES:
        least, known = nearest(bearings, ranges, side)
        for kind, words, distance in distances(bearings, ranges, side):
            if kind not in kinds:
                continue
            said = f"what your node takes for the distance is {words}"
            for heading in (*(bearing - np.pi / 2 for bearing in known), np.zeros(len(rates))):
                found.append((law(distance, heading, rates, asked), said))
        for bearing in known:
            found += errors(least, bearing - np.pi / 2, asked, rates)
            share = law(bearing, least - np.pi / 2, rates, asked)
            if share > EXACT:
                found.append(
                    (share, "range and bearing of the nearest point are exchanged: each is taken for the other")
                )
        for words, heading in headings(bearings, ranges, side):
            share = law(least, heading, rates, asked)
            found.append((share, f"the bearing of the nearest point, as your node has it, {words}"))
        for words, taken in directions(bearings):
            taken = np.remainder(taken + np.pi, 2 * np.pi) - np.pi
            other, others = nearest(taken, ranges, side)
            for bearing in others:
                share = law(other, bearing - np.pi / 2, rates, asked)
                found.append((share, f"your node counts the directions of the rays {words}"))
    return max(found)


def steers_by(
    bearings: np.ndarray, ranges: np.ndarray, rates: np.ndarray, asked: np.ndarray, kinds: Sequence[str]
) -> str:
    """Return what angular.z is made of, if that is clearly not the nearest point; empty if it may be.

    `kinds` are those of the wrong distances that the file may hold.
    """
    free = np.abs(rates) < 0.95 * LIMIT
    if len(rates) < SCANS or free.sum() < FEWEST or rates[free].var() < 0.005:
        return ""
    ranges = np.where(np.isfinite(ranges) & (ranges > 0.05), ranges, np.inf)
    right = best_right(bearings, ranges, rates, asked)
    if right > SURE:
        return ""
    share, words = best_wrong(bearings, ranges, rates, asked, kinds)
    return words if share > LEAST and 1 - share < BETTER * (1 - right) else ""


def times_speed(
    bearings: np.ndarray, ranges: np.ndarray, rates: np.ndarray, asked: np.ndarray, ahead: np.ndarray
) -> str:
    """Return words on rates [rad/s] that are the right ones multiplied by linear.x [m/s]; empty if they are not."""
    clear = np.abs(ahead) > 0.01
    if clear.sum() < SCANS or np.abs(rates).max() > 0.9 * LIMIT:
        return ""
    ranges = np.where(np.isfinite(ranges) & (ranges > 0.05), ranges, np.inf)[clear]
    before = np.clip(rates[clear] / ahead[clear], -LIMIT, LIMIT)
    if best_right(bearings, ranges, before, asked[clear]) < LIKE_RIGHT:
        return ""
    if best_right(bearings, ranges, rates[clear], asked[clear]) > LIKE_RIGHT - 0.05:
        return ""
    return (
        f"angular.z is multiplied by linear.x, so it is {np.abs(rates).max():.2f} rad/s at most: a rate of turning is "
        "in rad/s already, so leave the speed out of it"
    )
