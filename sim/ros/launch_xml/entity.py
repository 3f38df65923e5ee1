"""An element of a launch file in XML."""

from __future__ import annotations

import re
from typing import Any

from gz_course.sim.did_you_mean import did_you_mean, nearest_name
from gz_course.sim.ros.launch.errors import Place
from gz_course.sim.ros.launch.frontend.entity import Entity as FrontendEntity
from gz_course.sim.ros.launch.frontend.entity import EntityError, LaunchText
from gz_course.sim.ros.launch.frontend.type_utils import check_is_list_entity
from gz_course.sim.ros.launch.utilities.type_utils import get_typed_value, type_word

# What ROS 1 calls differently: attribute -> what to write.
_OTHER_NAMES = {
    "type": "exec",
    "executable": "exec",
    "package": "pkg",
    "ns": "namespace",
    "clear_params": "",
    "required": 'on_exit="shutdown"',
    "node-name": "name",
    "default_value": "default",
}


class Entity(FrontendEntity):
    """A tag with its attributes, which are text; `<name>-sep` tells what separates the items of a list."""

    def __init__(
        self,
        name: str,
        attributes: dict[str, str],
        *,
        source: LaunchText,
        line: int = 1,
        column: int = 1,
        parent: Entity | None = None,
    ) -> None:
        self.source = source
        self._name = name
        self._attributes = attributes
        self._line, self._column = line, column
        self._parent = parent
        self._children: list[Entity] = []
        self._asked: list[str] = []  # names of attributes and children, in the order they were asked for
        self._all_children_read = False
        source.count()

    @property
    def type_name(self) -> str:
        return self._name

    @property
    def parent(self) -> Entity | None:
        return self._parent

    @property
    def children(self) -> list[Any]:
        self._all_children_read = True
        return self._children

    def add(self, child: Entity) -> None:
        self._children.append(child)

    def described(self) -> str:
        return f"<{self._name}>"

    def place(self, attribute: str | None = None) -> Place:
        """Return where the tag, or its attribute, begins."""
        line, column = self._line, self._column
        if attribute in self._attributes:
            lines = self.source.text.splitlines(keepends=True)[line - 1 :]
            after = "".join(lines)[column - 1 :]
            found = re.search(rf"\s({re.escape(attribute)})\s*=", after)
            if found is not None:
                before = after[: found.start(1)]
                line += before.count("\n")
                column = len(before) - before.rfind("\n") if "\n" in before else column + len(before)
        return self.source.path, f"{line}:{column}"

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        self._asked.append(name)
        if check_is_list_entity(data_type):
            found = [child for child in self._children if child.type_name == name]
            if found or optional:
                return found or None
            raise EntityError(self, f"{self.described()} lacks <{name}>{self._nearest_child(name)}")
        if name not in self._attributes:
            if optional:
                return None
            raise EntityError(self, f"{self.described()} lacks the attribute '{name}'{self._nearest_attribute(name)}")
        self.source.read = self, name
        value: Any = self._attributes[name]
        separator = self._attributes.get(f"{name}-sep")
        self._asked.append(f"{name}-sep")
        if separator is not None:
            value = value.split(separator) if separator else [value]
        try:
            return get_typed_value(value, data_type, can_be_str=can_be_str)
        except (ValueError, TypeError):
            wanted = type_word(data_type)
            raise EntityError(self, f"'{name}' of {self.described()} is {value!r}, not {wanted}", name) from None

    def assert_entity_completely_parsed(self) -> None:
        """Raise EntityError for the first attribute or child that nobody has asked for."""
        for name in self._attributes:
            if name not in self._asked:
                raise EntityError(self, f"{self.described()} has no attribute '{name}'{self._meant(name)}", name)
        for child in self._children:
            if not self._all_children_read and child.type_name not in self._asked:
                hint = did_you_mean(child.type_name, self._asked)
                raise EntityError(child, f"{self.described()} cannot hold {child.described()}{hint}")

    def _meant(self, name: str) -> str:
        other = _OTHER_NAMES.get(name)
        if other and (other.partition("=")[0] in self._asked):
            return f"; write {other}"
        known = [each for each in dict.fromkeys(self._asked) if not each.endswith("-sep")]
        return did_you_mean(name, known, listing="it can have")

    def _nearest_attribute(self, name: str) -> str:
        other = [each for each in self._attributes if _OTHER_NAMES.get(each) == name]
        found = other[0] if other else nearest_name(name, self._attributes)
        return f"; it has '{found}'" if found else ""

    def _nearest_child(self, name: str) -> str:
        found = nearest_name(name, [each.type_name for each in self._children])
        return f"; it has <{found}>" if found else ""
