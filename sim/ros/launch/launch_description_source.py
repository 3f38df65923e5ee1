"""The source of an included launch description: the description itself, or a file to load."""

from __future__ import annotations

import contextlib
import os
from typing import TYPE_CHECKING

from gz_course.sim.ros.launch.invalid_launch_file_error import InvalidLaunchFileError
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.launch_context import LaunchContext
    from gz_course.sim.ros.launch.launch_description import LaunchDescription


class LaunchDescriptionSource:
    """A launch description, or its `location`; subclasses override `_get_launch_description`."""

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: SomeSubstitutionsType | os.PathLike[str] | None = None,
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self.__launch_description = launch_description
        self.__location = [] if location is None else normalize_to_list_of_substitutions(location)
        self.__expanded_location: str | None = None
        self.__known_location: str | None = None
        self.__is_known = False
        self.__looked_into: LaunchDescription | None = None
        self.method = method

    @property
    def location(self) -> str:
        """Return the path, or a description of its substitutions before they are performed."""
        return self.__expanded_location or describe_substitutions(self.__location)

    @property
    def has_plain_location(self) -> bool:
        """Return whether the path is plain text, without other substitutions."""
        from gz_course.sim.ros.launch.substitutions.text_substitution import TextSubstitution

        return bool(self.__location) and all(isinstance(part, TextSubstitution) for part in self.__location)

    def known_location(self, including_file: str | None = None) -> str | None:
        """Return the path if it is known before the launch runs, else None.

        Substitutions are performed as far as they need no running launch; ThisLaunchFileDir is the folder of
        `including_file`.
        """
        if self.__expanded_location is not None or not self.__location:
            return self.__expanded_location
        if not self.__is_known:
            from gz_course.sim.ros.launch.launch_context import LaunchContext

            self.__is_known = True
            context = LaunchContext()
            if including_file is not None:
                path = os.path.abspath(including_file)  # noqa: PTH100
                context.extend_locals({"current_launch_file_path": path})
                context.extend_locals({"current_launch_file_directory": os.path.dirname(path)})  # noqa: PTH120
            with contextlib.suppress(Exception):  # reported when the launch runs
                self.__known_location = perform_substitutions(context, self.__location)
        return self.__known_location

    def try_get_launch_description_without_context(self, including_file: str | None = None) -> LaunchDescription | None:
        """Return the launch description if its path is known before the launch runs, else None.

        Raises the errors of loading the file.
        """
        if self.__launch_description is None and self.__looked_into is None:
            location = self.known_location(including_file)
            if location is None:
                return None
            self.__looked_into = self._get_launch_description(location)
        return self.__launch_description or self.__looked_into

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        """Return the launch description, loaded at the first call."""
        if self.__launch_description is None:
            location = perform_substitutions(context, self.__location)
            self.__expanded_location = os.path.abspath(location) if location else location  # noqa: PTH100
            if self.__looked_into is not None and self.__known_location == location:
                self.__launch_description = self.__looked_into
            else:
                self.__launch_description = self._get_launch_description(location)
        return self.__launch_description

    def _get_launch_description(self, location: str) -> LaunchDescription:
        raise InvalidLaunchFileError(f"{type(self).__name__} does not say how '{location}' is loaded")

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.location})"
