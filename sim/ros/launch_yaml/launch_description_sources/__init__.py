"""The source for launch files in YAML."""

from gz_course.sim.ros.launch_yaml.launch_description_sources.yaml_launch_description_source import (
    YAMLLaunchDescriptionSource,
)

__all__ = ["YAMLLaunchDescriptionSource"]
