"""`ros_gz_sim` of ROS 2, for machines without it; an installed one comes first on the import path."""

import launch

from gz_course.sim.public_name import stand_beside

stand_beside(launch, __name__, "gz_course.sim.bridge.ros_gz_sim")
