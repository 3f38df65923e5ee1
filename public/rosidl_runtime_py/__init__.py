"""`rosidl_runtime_py` of ROS 2, for machines without it; an installed one comes first on the import path."""

from gz_course.sim.public_name import stand_for

stand_for(__name__, "gz_course.sim.ros.rosidl_runtime_py")
