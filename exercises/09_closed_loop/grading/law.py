"""By which law the commands follow the scans, fitted to the run: too late, with a wrong sign, with something added.

`misconceptions.py` asks for it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .wall import Run

LIMIT = 1.5  # [rad/s]
NEAR = 0.35  # [m] error up to which the approach grows with the error in most programs
SETTLED = 7.0  # [s] after the start
FEWEST = 60  # scans
CONSTANTS = np.arange(-4.0, 4.01, 0.2)  # [rad/s]
AGES = (3, 4, 5, 6, 8, 10, 12, 15)  # scans between a scan and the command that answers it
WINDOWS, SHARES = (8, 12, 20, 30, 40), (0.15, 0.1, 0.07, 0.05, 0.03)  # of moving averages: scans, weight of the newest


def opposite(run: Run, point: np.ndarray, rates: np.ndarray, asked: np.ndarray) -> str:
    """Return whether the robot turns the other way than it must wherever that is clear; empty if not."""
    wanted = 4 * np.clip(point[:, 0] - asked, -NEAR, NEAR) + 2 * (point[:, 1] - np.pi / 2)
    clear = (np.abs(wanted) > 0.6) & (np.abs(rates) > 0.1)
    if clear.sum() < FEWEST / 2 or np.mean(np.sign(rates[clear]) == np.sign(wanted[clear])) > 0.05:
        return ""
    return (
        "angular.z has the wrong sign: where the robot must turn to the left it turns to the right, and the other way "
        f"round; here side is {run.side!r}, and a positive angular.z turns to the left on either side, so its sign "
        "must change with the side"
    )


def circling(run: Run, values: np.ndarray) -> str:
    """Return whether the robot turns towards its wall all the time, far from it; empty if not."""
    late = run.times > SETTLED
    usual = float(np.median(values)) if len(values) else 0.0
    if len(values) < FEWEST or not late.any() or (run.error[late] > 0.1).mean() < 0.95:
        return ""
    if run.sign * usual < 0.5 or (np.abs(values - usual) < 0.05).mean() < 0.9 or np.abs(run.along).sum() < 2:
        return ""
    said = (
        f"angular.z is {usual:.2f} rad/s{', its limit,' if abs(usual) > 0.95 * LIMIT else ''} in nearly every command"
    )
    return (
        f"{said}: the robot turns towards its wall, in circles, because nothing turns it back once it heads for the "
        "wall; limit what the error of the distance asks for, so that the bearing of the nearest point can outweigh it"
    )


def unchanging(run: Run, values: np.ndarray) -> str:
    """Return whether nearly all commands [rad/s] are the same, whatever the lidar saw; empty if not."""
    found, counts = np.unique(np.round(values, 3), return_counts=True)
    if len(values) < FEWEST or counts.max() < 0.95 * len(values):
        return ""
    usual = found[counts.argmax()]
    if abs(usual) <= 0.95 * LIMIT:
        return (
            f"angular.z is {usual:.2f} rad/s in nearly every command, whatever the lidar sees: what it is made of does "
            "not change with the scans"
        )
    said = f"angular.z is at its limit, {usual:.2f} rad/s, in nearly every command, whatever the lidar sees"
    if run.side == "right":
        return (
            f"with side 'right' {said}: what it is made of is never 0 there; the bearings of rays on the right are "
            "negative, abeam is -pi/2, and a positive angular.z turns away from the wall"
        )
    return f"{said}: the error, or sum, that it is made of is never small and never changes its sign; log its terms"


def one_way(run: Run, point: np.ndarray, rates: np.ndarray, asked: np.ndarray) -> str:
    """Return whether the robot turns to one side only, where it must turn to the other as well; empty if not."""
    wanted = 4 * np.clip(point[:, 0] - asked, -NEAR, NEAR) + 2 * (point[:, 1] - np.pi / 2)
    turning = rates[np.abs(rates) > 0.02]
    if len(turning) < FEWEST:
        return ""
    way = float(np.sign(np.median(turning)))
    needed = (np.sign(wanted) == -way) & (np.abs(wanted) > 0.3)
    wrong = way * (point[:, 0] - asked) < -0.05  # too near while it turns towards the wall, or too far while away
    if np.mean(np.sign(turning) == way) < 0.99 or (needed & wrong).sum() < 20:
        return ""
    side = "left" if way * run.sign > 0 else "right"
    return (
        f"angular.z turns the robot to the {side} only, also in {(needed & wrong).sum()} scans in which it must turn "
        "the other way: the error that it is made of never changes its sign; an error is what is measured minus "
        "what is wanted, with its sign"
    )


def agrees(point: np.ndarray, rates: np.ndarray, asked: np.ndarray) -> float:
    """Return in which share of the clear cases the robot turns the way it must."""
    wanted = 4 * np.clip(point[:, 0] - asked, -NEAR, NEAR) + 2 * (point[:, 1] - np.pi / 2)
    clear = (np.abs(wanted) > 0.6) & (np.abs(rates) > 0.1)
    return float(np.mean(np.sign(rates[clear]) == np.sign(wanted[clear]))) if clear.any() else 0.0


def kept_beside(run: Run, settled: float) -> str:
    """Return by how much the kept distance differs from the one asked for, both times; empty if it does not."""
    off, ratios = [], []
    for chosen in ((run.times > settled) & (run.times < run.changed), run.times > run.changed + 6.0):
        if chosen.sum() < FEWEST or np.abs(run.along[chosen]).sum() < 1.0:
            return ""
        low, middle, high = np.percentile(run.error[chosen], (25, 50, 75))
        if not np.isfinite(high) or high - low > 0.16:
            return ""
        off.append(float(middle))
        ratios.append(1 + float(middle) / float(run.wanted[chosen][-1]))
    if min(np.abs(off)) < 0.1 or max(np.abs(off)) > 0.6 or off[0] * off[1] < 0:
        return ""
    usual, ratio = float(np.mean(off)), float(np.mean(ratios))
    if abs(off[0] - off[1]) <= 0.08:
        more, made = ("more", "smaller") if usual > 0 else ("less", "larger")
        return (
            f"the robot always keeps {abs(usual):.2f} m {more} than asked for, before the change and after it: your "
            f"node makes the distance {made} than the nearest range, such as by a length of the robot; the distance "
            "counts from the lidar to the wall"
        )
    if abs(ratios[0] - ratios[1]) > 0.12:
        return ""
    return (
        f"the robot always keeps about {ratio:.2f} times the distance that is asked for, before the change and after "
        "it: a factor is wrong, or the range is measured along a slanted ray and not to the nearest point"
    )


def deaf(point: np.ndarray, rates: np.ndarray, asked: np.ndarray) -> str:
    """Return whether the commands hardly depend on the distance where that is nearly right; empty if they do."""
    error, away = point[:, 0] - asked, point[:, 1] - np.pi / 2
    clear = (np.abs(error) < 0.25) & (np.abs(rates) < 0.95 * LIMIT)
    if clear.sum() < FEWEST or min(error[clear].std(), away[clear].std()) < 0.03:
        return ""
    terms = np.stack([error[clear], away[clear]], axis=1)
    gains = np.linalg.lstsq(np.hstack([terms, np.ones((len(terms), 1))]), rates[clear], rcond=None)[0]
    if _explained(terms, rates[clear]) < 0.7 or not -0.2 < gains[0] < 0.8 or gains[1] < 0.8:
        return ""
    return (
        f"angular.z hardly answers the distance, by {gains[0]:.1f} rad/s for each metre of error, where that is less "
        "than 0.25 m: the gain of the distance is far too low, or small errors are left out (a dead band)"
    )


def without_sign(point: np.ndarray, rates: np.ndarray, asked: np.ndarray) -> str:
    """Return whether the size of the error counts and not its sign; empty if not."""
    error, away = np.clip(point[:, 0] - asked, -NEAR, NEAR), point[:, 1] - np.pi / 2
    clear = np.abs(rates) < 0.95 * LIMIT
    if clear.sum() < FEWEST or rates[clear].var() < 0.01:
        return ""
    if min((error[clear] < -0.05).sum(), (error[clear] > 0.05).sum()) < 15:
        return ""
    signed = _explained(np.stack([error, away], axis=1)[clear], rates[clear])
    size = _explained(np.stack([np.abs(error), away], axis=1)[clear], rates[clear])
    if size < 0.75 or 1 - size > 0.4 * (1 - signed):
        return ""
    return (
        "angular.z answers how large the error of the distance is, and not its sign: the robot turns the same way "
        "whether it is too near or too far (abs(), or a square)"
    )


def _fit(
    error: np.ndarray, away: np.ndarray, rates: np.ndarray, constants: list[float] | np.ndarray
) -> Iterator[tuple[float, float]]:
    """Yield how much of the rates limited sums of both errors and a constant explain, and the constant."""
    for near in (0, 1, 2, 4, 6):
        for turned in (0.5, 1, 2, 3, 4):
            sums = near * np.clip(error, -NEAR, NEAR) + turned * away
            for constant in constants:
                left = rates - np.clip(sums + constant, -LIMIT, LIMIT)
                yield float(1 - np.mean(left**2) / max(rates.var(), 1e-9)), float(constant)


def offset(point: np.ndarray, rates: np.ndarray, asked: np.ndarray) -> str:
    """Return which rate is commanded where nothing is wrong, if that is far from 0; empty if it is not."""
    error, away = point[:, 0] - asked, point[:, 1] - np.pi / 2
    if len(rates) < FEWEST / 2 or rates.var() < 0.02:
        return ""
    none, constant = max(_fit(error, away, rates, [0.0])), max(_fit(error, away, rates, CONSTANTS))
    if constant[0] < 0.8 or 1 - constant[0] > 0.4 * (1 - none[0]) or abs(constant[1]) < 0.5:
        return ""
    rate = constant[1]
    return (
        f"angular.z is still about {min(abs(rate), LIMIT):.1f} rad/s {'towards' if rate > 0 else 'away from'} the wall "
        "where the distance is right and the wall abeam: the error that it is made of must be 0 there: the nearest "
        "range minus the parameter distance, and the bearing of that point minus pi/2"
    )


def answers_old(point: np.ndarray, rates: np.ndarray, old: float, new: float) -> bool:
    """Return whether the commands fit an old distance [m] clearly better than the new one."""
    return agrees(point, rates, np.full(len(rates), old)) > agrees(point, rates, np.full(len(rates), new)) + 0.1


def left_alone(point: np.ndarray, rates: np.ndarray, asked: np.ndarray) -> str:
    """Return whether angular.z is exactly 0 where the distance is about right, however wrong the heading is."""
    error, away = np.abs(point[:, 0] - asked), np.abs(point[:, 1] - np.pi / 2)
    none = np.abs(rates) < 1e-6
    if none.sum() < 15 or (~none).sum() < 15 or np.percentile(error[none], 95) > 0.25 or away[none].max() < 0.2:
        return ""
    within = float(np.percentile(error[none], 95))
    if none[error < 0.7 * within].mean() < 0.8:
        return ""
    return (
        f"angular.z is exactly 0 in {none.sum()} scans, those in which the distance was right within {within:.2f} m, "
        f"although the heading was wrong by up to {away[none].max():.1f} rad then: the robot leaves that band at an "
        "angle; correct the heading there, too"
    )


def heeds_heading(point: np.ndarray, rates: np.ndarray, asked: np.ndarray) -> bool:
    """Return whether the turning rates depend on the heading, too, as far as that can be seen."""
    error, away = np.clip(point[:, 0] - asked, -NEAR, NEAR), point[:, 1] - np.pi / 2
    clear = np.abs(rates) < 0.95 * LIMIT
    if clear.sum() < FEWEST or rates[clear].var() < 1e-3:
        return False
    alone, both = error[clear, None], np.stack([error, away], axis=1)[clear]
    share = _explained(both, rates[clear])
    return share > 0.8 and 1 - share < 0.3 * (1 - _explained(alone, rates[clear])) - 1e-6


def strong(point: np.ndarray, rates: np.ndarray, asked: np.ndarray) -> str:
    """Return the gain of the distance if that is far too high for the time between two scans; empty if it is not."""
    error, away = point[:, 0] - asked, point[:, 1] - np.pi / 2
    clear = (np.abs(rates) < 0.95 * LIMIT) & (np.abs(error) < NEAR)
    if clear.sum() < FEWEST or error[clear].std() < 0.01:
        return ""
    terms = np.stack([error, away], axis=1)[clear]
    gains = np.linalg.lstsq(np.hstack([terms, np.ones((len(terms), 1))]), rates[clear], rcond=None)[0]
    if _explained(terms, rates[clear]) < 0.6 or gains[0] < 7 or gains[0] < 3 * gains[1]:
        return ""
    return (
        f"angular.z answers the distance by {gains[0]:.0f} rad/s for each metre of error, and the heading by "
        f"{max(gains[1], 0.0):.1f} rad/s for each radian: the gain of the distance is far too high, so the robot swings"
    )


def late(point: np.ndarray, rates: np.ndarray, asked: np.ndarray, moving: bool | np.ndarray = True) -> str:
    """Return how old what the commands answer is, if they follow a moving average of the scans; empty if not.

    Where the robot does not move, all scans are much the same.
    """
    terms = np.stack([np.clip(point[:, 0] - asked, -NEAR, NEAR), point[:, 1] - np.pi / 2], axis=1)
    clear = (np.abs(rates) < 0.95 * LIMIT) & moving
    if clear.sum() < FEWEST or rates[clear].var() < 1e-3:
        return ""
    now = _explained(terms[clear], rates[clear])
    clear_at = np.flatnonzero(clear)
    clear_at = clear_at[clear_at >= max(AGES)]
    found = [(_explained(_mean(terms, number)[clear], rates[clear]), number / 2) for number in WINDOWS]
    found += [(_explained(_weighed(terms, share)[clear], rates[clear]), 1 / share) for share in SHARES]
    best, scans = max(found)
    passed = [(_explained(terms[clear_at - ago], rates[clear_at]), ago) for ago in AGES]
    older, ago = max(passed)
    if older > max(0.8, best) and 1 - older < 0.4 * (1 - now):
        return (
            f"angular.z answers what the lidar saw {ago} scans before, not what it sees now, so the robot turns too "
            "late, and swings; send the rate of each scan as it comes"
        )
    if best < 0.8 or 1 - best > 0.4 * (1 - now):
        return ""
    return (
        f"angular.z answers an average of the last scans, which is about {scans:.0f} scans old, not what the lidar "
        "sees now: such smoothing delays the feedback, so the robot turns too late, and swings; use each scan as it "
        "comes"
    )


def _explained(terms: np.ndarray, rates: np.ndarray) -> float:
    terms = np.hstack([terms, np.ones((len(terms), 1))])
    left = rates - terms @ np.linalg.lstsq(terms, rates, rcond=None)[0]
    return float(1 - left.var() / max(rates.var(), 1e-9))


def _mean(terms: np.ndarray, number: int) -> np.ndarray:
    """Return the mean of each row and those before it, `number` rows at most."""
    sums = np.cumsum(np.vstack([np.zeros((1, terms.shape[1])), terms]), axis=0)
    end = np.arange(1, len(terms) + 1)
    start = np.maximum(end - number, 0)
    return (sums[end] - sums[start]) / (end - start)[:, None]


def _weighed(terms: np.ndarray, share: float) -> np.ndarray:
    """Return the moving average in which each new row counts for a share."""
    found = terms.copy()
    for i in range(1, len(found)):
        found[i] = found[i - 1] + share * (terms[i] - found[i - 1])
    return found
