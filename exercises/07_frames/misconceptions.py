"""Where points lie if they are those of other rays, or of another heading; and in what wrong points are right."""

import numpy as np

CLOSE = 0.03  # [m]
SAME_WAY = 0.03  # [rad]
SHARE = 0.9  # of the points
SIGNS = (1, -1, -1), (-1, 1, -1), (-1, -1, 1), (1, 1, 1)  # of the diagonal, for x, y, z, w


def about_z(angle):
    c, s, zero = np.cos(angle), np.sin(angle), np.zeros_like(angle)
    return np.stack([np.stack([c, -s, zero], -1), np.stack([s, c, zero], -1), np.stack([zero, zero, zero + 1], -1)], -2)


def polar(distance, angle):
    """Return points (n, 3) [m] in the plane of the scanner."""
    return np.stack([distance * np.cos(angle), distance * np.sin(angle), np.zeros_like(angle)], -1)


def of_other_headings(turn, hits, given):
    """Yield hits (n, 3) [m] turned about z by what is not the heading of the rotations (n, 3, 3).

    A quaternion and its opposite are the same rotation: of the points of both, those near the given ones (n, 3) count.
    """
    heading = np.arctan2(turn[:, 1, 0], turn[:, 0, 0])
    right = "the heading is 2 * atan2(q.z, q.w)"
    signs = (np.sin(heading / 2), np.cos(heading / 2)), (-np.sin(heading / 2), -np.cos(heading / 2))
    angles = {
        f"turned by q.z as if it were an angle: {right}": lambda z, w: z,
        f"turned by q.w as if it were an angle: {right}": lambda z, w: w,
        f"turned by 2 * q.z: {right}": lambda z, w: 2 * z,
        f"turned by half the heading: {right}": np.arctan2,
        "turned by the heading in degrees: cos() and sin() take radians": lambda z, w: np.degrees(2 * np.arctan2(z, w)),
        f"turned by an angle whose z and w are exchanged: {right}": lambda z, w: 2 * np.arctan2(w, z),
    }
    for words, angle in angles.items():
        one, other = (np.einsum("nij,nj->ni", about_z(angle(z, w)), hits) for z, w in signs)
        nearer = np.linalg.norm(one - given, axis=1) <= np.linalg.norm(other - given, axis=1)
        yield words, np.where(nearer[:, None], one, other)


def of_other_quaternions(turn):
    """Yield quaternions (x, y, z, w), each (n,), that are not those of the rotations (n, 3, 3)."""
    squares = [1 + turn[:, 0, 0] * a + turn[:, 1, 1] * b + turn[:, 2, 2] * c for a, b, c in SIGNS]
    x, y, z, w = (np.sqrt(np.maximum(square, 0)) / 2 for square in squares)
    x = np.copysign(x, turn[:, 2, 1] - turn[:, 1, 2])
    y = np.copysign(y, turn[:, 0, 2] - turn[:, 2, 0])
    z = np.copysign(z, turn[:, 1, 0] - turn[:, 0, 1])
    words = "those of a quaternion in another order: ROS has x, y, z, w"
    yield words, (w, x, y, z)
    yield words, (y, z, w, x)
    yield words, (z, y, x, w)


def of_other_rays(found):
    """Yield points in the scanner's frame that take another ray, or another direction for the ray."""
    first, step = found.angles.T
    distance = np.linalg.norm(found.hits, axis=-1)
    around = 2 * np.pi * found.rays / np.array([len(row) for row in found.rows])
    angle = first + found.rays * step
    yield "off by angle_min: the angle of a ray is angle_min + i * angle_increment", polar(distance, found.rays * step)
    yield "those of an angle in degrees: cos() and sin() take radians", polar(distance, np.degrees(angle))
    yield "on the other side: angles grow to the left, y is range * sin(angle)", polar(distance, -angle)
    yield "those with sin and cos exchanged: x is range * cos(angle)", polar(distance, np.pi / 2 - angle)
    yield "those of rays all around: use angle_min and angle_increment", polar(distance, around)
    yield "those of rays all around, from -pi on: use angle_min and angle_increment", polar(distance, around - np.pi)
    yield "those of a ray's number as its angle: angle_increment is missing", polar(distance, first + found.rays)
    numbers = np.radians(found.rays)
    yield "those of a ray's number as its angle in degrees: use angle_min and angle_increment", polar(distance, numbers)
    yield "those of a ray's number in degrees: use angle_increment", polar(distance, first + numbers)
    yield "off by one ray: their angle is that of the ray before", polar(distance, angle - step)
    yield "off by one ray: their angle is that of the next ray", polar(distance, angle + step)
    yield "those of the nearest distance, drawn straight ahead of the scanner", polar(distance, 0 * angle)
    valid = [
        np.where((row > low) & (row < high), row, np.nan)
        for row, (low, high) in zip(found.rows, found.limits, strict=True)
    ]
    means = np.array([np.nanmean(row) for row in valid])
    yield "at the average distance of all hits, not at that of the nearest", polar(means, angle)
    others = {
        "the farthest hit, not the nearest": np.nanargmax,
        "the hit of the first valid ray, not the nearest": lambda row: np.flatnonzero(~np.isnan(row))[0],
        "the hit of the last valid ray, not the nearest": lambda row: np.flatnonzero(~np.isnan(row))[-1],
        "the hit of the ray in the middle, not the nearest": lambda row: len(row) // 2,
    }
    for words, ray_of in others.items():
        rays = np.array([ray_of(row) for row in valid])
        yield words, polar(np.array([row[i] for row, i in zip(valid, rays, strict=True)]), first + rays * step)
    every = [polar(row, a + np.arange(len(row)) * b) for row, a, b in zip(valid, first, step, strict=True)]
    yield "the middle of all hits, not the nearest", np.array([np.nanmean(points, 0) for points in every])


def apart(points, truth, seen, hits):
    """Return in what wrong points are right, as the end of "your points are ..."; empty if in nothing.

    `points` and `truth` are in odom, `seen` and `hits` the same in the scanner's frame, all (n, 3) [m].
    """
    there = ~np.isnan(points[:, 0])
    points, truth, seen, hits = points[there], truth[there], seen[there], hits[there]
    shift, factors = np.median(points - truth, 0), np.linalg.norm(seen, axis=1) / np.linalg.norm(hits, axis=1)
    angles = np.arctan2(seen[:, 1], seen[:, 0]) - np.arctan2(hits[:, 1], hits[:, 0])
    angles = np.remainder(angles + np.pi, 2 * np.pi) - np.pi
    off = np.abs(points - truth) <= CLOSE
    same = ("x", "y", "z", "x and y")
    axes = [name for name, each in zip(same, (*off.T, off[:, 0] & off[:, 1]), strict=True) if each.mean() >= SHARE]
    if np.mean(np.linalg.norm(points - truth - shift, axis=1) <= CLOSE) >= SHARE:
        return f"all shifted by the same way in odom, ({', '.join(f'{v:.2f}' for v in shift)}) m"
    if np.mean(np.abs(np.linalg.norm(seen, axis=1) - np.linalg.norm(hits, axis=1)) <= CLOSE) >= SHARE:
        usual = float(np.median(angles))
        if np.mean(np.abs(angles - usual) <= SAME_WAY) >= SHARE:
            return f"as far from the scanner as the hits, in directions that are {np.degrees(usual):.0f} degrees off"
        return "as far from the scanner as the hits, in other directions: the angle, or a rotation, is wrong"
    if np.mean(np.abs(angles) <= SAME_WAY) >= SHARE and "z" in axes:
        usual = float(np.median(factors))
        times = f", {usual:.2f} times as far" if np.mean(np.abs(factors / usual - 1) <= 0.02) >= SHARE else ""
        more = np.linalg.norm(seen, axis=1) - np.linalg.norm(hits, axis=1)
        if np.mean(np.abs(more - np.median(more)) <= CLOSE / 2) >= SHARE:
            times = f", all {abs(np.median(more)):.2f} m too {'far' if np.median(more) > 0 else 'near'}"
        return f"in the right directions from the scanner, but at other distances{times}"
    return f"right in {axes[-1]} only" if axes else ""
