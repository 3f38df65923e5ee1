"""ros_gz_interfaces: what only Gazebo has words for: entities, contacts, lights, parameters; and its services."""

from gz_course.sim.ros_gz_bridge.convert.ros_gz_interfaces import messages, parameters, services  # noqa: F401
