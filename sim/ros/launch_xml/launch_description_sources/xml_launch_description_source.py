"""The source for launch files in XML."""

from __future__ import annotations

import os

from gz_course.sim.ros.launch.launch_description_sources import FrontendLaunchDescriptionSource
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch_xml.parser import Parser


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """The launch file in XML at a path, which may contain substitutions."""

    def __init__(self, launch_file_path: SomeSubstitutionsType | os.PathLike[str]) -> None:
        super().__init__(launch_file_path, parser=Parser())
