"""The source for launch files in XML."""

from gz_course.sim.ros.launch_xml.launch_description_sources.xml_launch_description_source import (
    XMLLaunchDescriptionSource,
)

__all__ = ["XMLLaunchDescriptionSource"]
