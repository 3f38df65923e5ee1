"""geometry_msgs: vectors, rotations, poses, transforms, twists and wrenches.

Lengths are metres, angles radians, speeds m/s and rad/s, forces newtons; both sides use the same units, so
every number is copied. Quaternions are x, y, z, w on both sides and copied as they are: one that was never
filled in stays 0, 0, 0, 0, and its sign is kept.
"""

from gz_course.sim.ros_gz_bridge.convert.geometry_msgs import poses, twists  # noqa: F401
