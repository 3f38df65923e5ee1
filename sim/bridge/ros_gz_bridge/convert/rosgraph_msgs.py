"""rosgraph_msgs: Clock, the simulated time for nodes with `use_sim_time`.

Source: ros_gz_bridge/src/convert/rosgraph_msgs.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

from rosgraph_msgs.msg import Clock

from gz_course.sim.bridge.ros_gz_bridge.fields import Part, message_pair
from gz_course.sim.bridge.ros_gz_bridge.header import copy_stamp, fill_stamp

# Gazebo's `real` and `system` times have no field in the ROS message.
message_pair(
    "rosgraph_msgs/msg/Clock",
    "gz.msgs.Clock",
    Part(Clock, lambda gz, ros: fill_stamp(gz.sim, ros.clock), lambda ros, gz: copy_stamp(ros.clock, gz.sim)),
)
