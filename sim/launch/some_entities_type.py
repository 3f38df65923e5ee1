"""SomeEntitiesType, in the module where launch of ROS 2 has it."""

from gz_course.sim.launch.launch_description_entity import SomeEntitiesType as SomeEntitiesType
