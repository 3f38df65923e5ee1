"""What a server takes for its heading, or for the direction to a waypoint, as the way tells that the robot drives."""

import numpy as np

DRIVES = 0.08  # [m/s]
FACES = 0.35  # [rad] a server that drives believes that the waypoint is ahead
FEWEST = 20  # samples of a robot that drives
TURNS = 0.02  # [rad/s] a robot that turns less steers by no angle
REACHED = 0.17  # [m]
ASIDE = 0.8  # [rad]
RIGHT = "the heading is 2 * atan2(orientation.z, orientation.w), in radians"
HEADINGS = {
    f"its heading is in degrees, and atan2 returns radians: {RIGHT}": np.degrees,
    f"its heading is half of what it is: {RIGHT}": lambda yaw: yaw / 2,
    f"its heading has the wrong sign: {RIGHT}": lambda yaw: -yaw,
    f"its heading is never negative, as of acos: {RIGHT}": np.abs,
    f"its heading does not change when the robot turns: {RIGHT}": lambda yaw: 0 * yaw,
}
DIRECTIONS = {
    "it takes the direction to a waypoint for atan2(dx, dy); atan2 takes y first": lambda d, p: np.arctan2(
        d[:, 0], d[:, 1]
    ),
    "it takes the opposite direction, from the waypoint to the robot: dx is waypoint.x - x, and dy is waypoint.y - y": (
        lambda d, p: np.arctan2(-d[:, 1], -d[:, 0])
    ),
    "it takes the direction from the origin of odom to the waypoint; dx and dy begin where the robot is": (
        lambda d, p: np.full(len(d), np.arctan2(p[1], p[0]))
    ),
}


def _wrapped(angle):
    return np.remainder(angle + np.pi, 2 * np.pi) - np.pi


def _missed(way, points):
    """Return the first waypoint that a way misses, and where in the way the robot sets out for it."""
    after = 0
    for point in points:
        left = np.hypot(*(way[after:] - point).T)
        if left.min() > REACHED:
            return point, after
        after += int(np.argmax(left <= REACHED))
    return points[-1], len(way) - 1


def wrong_bearing(run, chosen, points):
    """Return by which wrong angle the server faces a waypoint that the robot misses; empty if none fits its way."""
    way, yaw, speed, rate = (each[chosen] for each in (run.way, run.heading, run.linear.values, run.angular.values))
    missed, after = _missed(way, points)
    driving = np.arange(len(way)) >= after
    driving &= speed > DRIVES
    if driving.sum() < FEWEST:
        return ""
    beside, yaw, rate = missed - way[driving], yaw[driving], rate[driving]
    direction = np.arctan2(beside[:, 1], beside[:, 0])
    error = _wrapped(direction - yaw)
    if np.abs(rate).max() < TURNS or np.mean(np.abs(error) < FACES) > 0.5:
        return ""
    shares = {words: _share(direction - taken(yaw)) for words, taken in HEADINGS.items()}
    shares |= {words: _share(taken(beside, missed) - yaw) for words, taken in DIRECTIONS.items()}
    best = max(shares, key=shares.__getitem__)
    if shares[best] > 0.85:
        return f"Your server drives as if the waypoint were ahead where it is not: {best}"
    aside = np.abs(error) > ASIDE
    if aside.mean() > 0.5 and np.mean(np.sign(rate[aside]) == np.sign(error[aside])) > 0.8:
        off = np.degrees(np.median(np.abs(error)))
        return (
            f"The robot turns to the correct side, but drives on although the waypoint is {off:.0f} degrees beside its "
            "heading, so it circles: let it drive only while the angle to turn by is small"
        )
    return ""


def _share(error):
    return float(np.mean(np.abs(_wrapped(error)) < FACES))
