"""ROS 2's `launch`, for machines without it: a real one comes earlier on the import path."""

from gz_course.sim.public_name import stand_for

stand_for(__name__, "gz_course.sim.launch")
