"""sensor_msgs: cameras, lidars, and what other sensors, joints, batteries and joysticks report.

SI units and radians on both sides, except latitude and longitude [deg].

Source: REP-103, https://www.ros.org/reps/rep-0103.html; sensor_msgs/msg/*.msg of common_interfaces
"""

from gz_course.sim.bridge.ros_gz_bridge.convert.sensor_msgs import cameras, lidars, readings  # noqa: F401
