"""`python -m gz_course.sim.ros.ros2 …` is `ros2 …`."""

import sys

from gz_course.sim.ros.ros2.command_line import main

sys.exit(main())
