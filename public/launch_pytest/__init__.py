"""`launch_pytest` of ROS 2, for machines without it; an installed one comes first on the import path."""

import launch

from gz_course.sim import launch as own_launch
from gz_course.sim.public_name import stand_for

if launch is not own_launch:
    raise ImportError(
        f"launch comes from {launch.__path__[0]}, but no launch_pytest stands beside it, and that of the course works "
        "with the course's launch only; install launch_pytest there, too, or remove that launch"
    )
stand_for(__name__, "gz_course.sim.launch_pytest")
