"""The differences from Gazebo that stay: the sentence about each, which the simulator's README has word for word, and
the rows of the table that show it, as patterns of `scene | measure`.
"""

from fnmatch import fnmatchcase

DIFFERENCES: dict[str, tuple[str, ...]] = {
    "Friction is a cone: its limit is the same in all directions. Gazebo's is a pyramid along `fdir1`, larger between "
    "its axes: a box that slides at 45 degrees to them stops there after 0.48 m, here after 0.68 m, which is the closed"
    " form.": ("at 45 degrees to fdir1 | *",),
    "A driven wheel that is a cylinder touches a plane at one point, in its middle. In Gazebo it touches at both "
    "edges, and a robot on two such wheels turns 11 % to 14 % faster than commanded, one on four slower. The wheels of "
    "the course's robots are thin; a wide wheel causes a warning.": (
        "slip1 0.035, cylinders: on the spot | yaw*",
        "caster of mu 0, cylinder tyres: * | turning*",
        "caster of mu 1, cylinder tyres: * | way*",
    ),
    "`mu2`, `fdir1` and `slip1` count for round wheels of a `DiffDrive` on a plane, with `fdir1` along the axle. "
    "Elsewhere they have no effect, and cause a warning; so does `slip2`.": ("along mu2 0.1, with mu 1 | *",),
    "A robot with four wheels without directions turns with 95 % of the commanded rate. In Gazebo it does not turn "
    "without slip; a warning says so.": (
        "no slip, mu2 = mu: on the spot | x*",
        "no slip, mu2 = mu: on the spot | yaw*",
    ),
    "A sphere that is fixed to a robot with driven wheels slides with less friction than its mu: it slows down by no "
    "more than twice its speed per second. Weak motors drag it faster than in Gazebo; strong ones do not feel it.": (
        "motors of 0.15 N m * | *",
        "motors of 0.25 N m * | *",
    ),
    "Two rigid casters of mu 1 take the load off the wheels in Gazebo, and the robot hardly moves.": (
        "rigid casters of mu 1 * | speed*",
        "rigid casters of mu 1 * | turning*",
    ),
    "A sphere of 5 cm does not pass a wall of 1 cm at 40 m/s.": ("a sphere of 5 cm at 40 m/s * | *",),
}


def reason(scene: str, measure: str) -> str:
    """The sentence about a row; empty if it is the same as in Gazebo."""
    row = f"{scene} | {measure}"
    return next((text for text, rows in DIFFERENCES.items() if any(fnmatchcase(row, each) for each in rows)), "")
