"""rosgraph_msgs: Clock, the simulated time that every node with `use_sim_time` takes as its own."""

from __future__ import annotations

from rosgraph_msgs.msg import Clock

from gz_course.sim.ros_gz_bridge.fields import Part, message_pair
from gz_course.sim.ros_gz_bridge.header import copy_stamp, fill_stamp

# Gazebo's `real` and `system` times have no field in the ROS message.
message_pair(
    "rosgraph_msgs/msg/Clock",
    "gz.msgs.Clock",
    Part(Clock, lambda gz, ros: fill_stamp(gz.sim, ros.clock), lambda ros, gz: copy_stamp(ros.clock, gz.sim)),
)
