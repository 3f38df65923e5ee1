"""Maps in which scans are drawn from where the robot was a little earlier or later than when they were taken."""

from __future__ import annotations

import numpy as np

from gz_course.grader.score.floor import Grid, Scans, grown, hits

GRID = Grid(0.1, 100, 80, -5.0, -4.0)
FREE = 25  # at most
FEWEST = 30  # cells in a wrong place
LONGEST, STEP = 5.0, 0.25  # [scans] between a scan and the pose by which it is drawn
PERIOD = 0.2  # [s] between two scans
FITS, MORE = 0.9, 0.3  # of the wrong cells; so much more than of the free ones
CLEARER = 0.1  # by which the better of two directions in time explains more


def drawn_late(said: np.ndarray, marked: np.ndarray, solid: np.ndarray, scan: Scans) -> str:
    """Return that the walls in a wrong place lie where old or later poses draw them; empty if they do not."""
    wrong = marked & ~grown(solid)
    free = (said >= 0) & (said <= FREE) & ~grown(solid)
    if wrong.sum() < FEWEST or not free.any() or len(scan.pose) < 10:
        return ""
    shares, union = {}, {sign: np.zeros_like(marked) for sign in (1, -1)}
    for lag in np.arange(STEP, LONGEST + STEP / 2, STEP):
        for sign in (1, -1):
            drawn = GRID.cells(hits(scan, pose=earlier(scan.pose, sign * lag))) > 0
            union[sign] |= drawn
            shares[sign] = union[sign][wrong].mean()
        best = max(shares, key=lambda sign: shares[sign])
        if shares[best] < FITS:
            continue
        if shares[best] < union[best][free].mean() + MORE:
            return ""
        when = "earlier" if best > 0 else "later"
        if shares[best] < shares[-best] + CLEARER:
            when = "earlier or later"
        return (
            "walls are drawn beside their place wherever the robot moved or turned: scans are drawn with a pose of the "
            f"robot up to about {lag * PERIOD:.1f} s {when} than the scan; the pose belongs to the time in "
            "scan.header.stamp"
        )
    return ""


def earlier(pose: np.ndarray, lag: float) -> np.ndarray:
    """Return the poses (n, 3) at which the robot was so many scans earlier, or later if negative."""
    number = np.arange(len(pose), dtype=float)
    at = np.clip(number - lag, 0, len(pose) - 1)
    columns = pose[:, 0], pose[:, 1], np.unwrap(pose[:, 2])
    return np.stack([np.interp(at, number, each) for each in columns], 1)
