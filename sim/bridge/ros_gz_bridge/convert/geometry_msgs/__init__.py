"""geometry_msgs: vectors, rotations, poses, transforms, twists and wrenches.

Both sides use the units of REP-103 ([m], [rad], [m/s], [rad/s], [N], [N m]), so every number is copied. Quaternions are
x, y, z, w on both sides and copied without normalization: an unset one remains 0, 0, 0, 0.

Source: REP-103, https://www.ros.org/reps/rep-0103.html; ros_gz_bridge/src/convert/geometry_msgs.cpp
"""

from gz_course.sim.bridge.ros_gz_bridge.convert.geometry_msgs import poses, twists  # noqa: F401
