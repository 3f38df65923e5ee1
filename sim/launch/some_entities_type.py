"""SomeEntitiesType, in the module where launch of ROS 2 has it."""

from launch.launch_description_entity import SomeEntitiesType as SomeEntitiesType
