"""An element of a launch file in XML or YAML: its name, attributes and children.

Entities note what is read of them, so that what nobody reads is an error, and where they stand, for errors.
"""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch.errors import Place
from gz_course.sim.ros.launch.invalid_launch_file_error import InvalidLaunchFileError

_MOST = 20_000  # entities of a file; aliases of YAML could make a small file endless


class LaunchText:
    """The file that is being read. `read` is the last attribute that was asked for, which an error may concern."""

    def __init__(self, path: str, text: str) -> None:
        self.path = path
        self.text = text
        self.read: tuple[Entity, str] | None = None
        self._entities = 0

    def count(self) -> None:
        """Raise InvalidLaunchFileError for a file of endless size."""
        self._entities += 1
        if self._entities > _MOST:
            raise InvalidLaunchFileError(f"{self.path}: it holds more than {_MOST} elements, too many")


class Entity:
    """An element. `launch_xml` and `launch_yaml` have the classes that are made of files."""

    source = LaunchText("<text>", "")

    @property
    def type_name(self) -> str:
        """Return the name of the element, such as `node`."""
        raise NotImplementedError

    @property
    def parent(self) -> Entity | None:
        raise NotImplementedError

    @property
    def children(self) -> list[Entity]:
        raise NotImplementedError

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return an attribute as `data_type`: str, int, float, bool, a List of one of them, or None for any of these.

        `List[Entity]` gives the children of that name. With `can_be_str` text of another kind is returned as it is,
        for it may hold substitutions. A missing attribute is None if it is `optional`, else an AttributeError; one
        of another type is a TypeError.
        """
        raise NotImplementedError

    def assert_entity_completely_parsed(self) -> None:
        """Raise ValueError if there are attributes or children that nobody has read."""

    def place(self, attribute: str | None = None) -> Place:
        """Return where the element, or one of its attributes, stands."""
        return self.source.path, "1:1"

    def described(self) -> str:
        """Return the element as the file writes it, `<node>` or `node`."""
        return self.type_name


class EntityError(InvalidLaunchFileError, AttributeError, TypeError, ValueError):
    """An element is not as its action wants it. All these classes, because ROS 2's launch raises one of them."""

    def __init__(self, entity: Entity, sentence: str, attribute: str | None = None) -> None:
        place = entity.place(attribute)
        super().__init__(f"{place[0]}:{place[1]}: {' '.join(sentence.split())}")
        self.launch_place = place
