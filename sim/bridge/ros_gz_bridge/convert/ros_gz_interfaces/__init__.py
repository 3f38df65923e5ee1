"""ros_gz_interfaces: entities, contacts, lights and parameters of Gazebo, and its services.

Source: ros_gz_interfaces/msg/*.msg and srv/*.srv, https://github.com/gazebosim/ros_gz/tree/jazzy/ros_gz_interfaces
"""

from gz_course.sim.bridge.ros_gz_bridge.convert.ros_gz_interfaces import messages, parameters, services  # noqa: F401
