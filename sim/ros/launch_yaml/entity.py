"""An element of a launch file in YAML."""

from __future__ import annotations

from typing import Any

from gz_course.sim.did_you_mean import did_you_mean, nearest_name
from gz_course.sim.ros.launch.errors import Place
from gz_course.sim.ros.launch.frontend.entity import Entity as FrontendEntity
from gz_course.sim.ros.launch.frontend.entity import EntityError, LaunchText
from gz_course.sim.ros.launch.frontend.type_utils import check_is_list_entity
from gz_course.sim.ros.launch.utilities.type_utils import is_instance_of, type_word

_CHILDREN = "children"


class Mapping(dict[Any, Any]):
    """A mapping of the file; `places` are the `line:column` of its keys."""

    def __init__(self) -> None:
        super().__init__()
        self.places: dict[Any, str] = {}


class Entity(FrontendEntity):
    """A key with what stands below it: a mapping of attributes, or a list of children."""

    def __init__(
        self,
        element: Any,
        type_name: str,
        *,
        source: LaunchText,
        where: str = "1:1",
        parent: Entity | None = None,
    ) -> None:
        self.source = source
        self._element = element
        self._name = type_name
        self._where = where
        self._parent = parent
        self._asked: list[str] = []
        self._children: list[Entity] | None = None
        source.count()

    @property
    def type_name(self) -> str:
        return self._name

    @property
    def parent(self) -> Entity | None:
        return self._parent

    @property
    def children(self) -> list[Any]:
        """Return the elements of the list, or of the list below the key `children`. Raises EntityError."""
        if self._children is None:
            below = self._element
            if isinstance(below, Mapping):
                self._asked.append(_CHILDREN)
                if _CHILDREN not in below:
                    raise EntityError(self, f"{self.described()} lacks the key '{_CHILDREN}', a list of actions")
                below = below[_CHILDREN]
            if not isinstance(below, list):
                raise EntityError(self, f"below {self.described()} stands {_shown(below)}, not a list of actions")
            self._children = [self._child(each) for each in below]
        return self._children

    def _child(self, item: Any) -> Entity:
        if not isinstance(item, Mapping) or len(item) != 1 or not isinstance(next(iter(item)), str):
            place = self.place() if not isinstance(item, Mapping) or not item else None
            where = str(place[1]) if place else next(iter(item.places.values()))
            seen = f"the keys {', '.join(map(str, item))}" if isinstance(item, Mapping) and item else _shown(item)
            hint = "; indent its attributes more" if isinstance(item, Mapping) and len(item) > 1 else ""
            stand_in = Entity(item, self._name, source=self.source, where=where)
            raise EntityError(
                stand_in, f"an item of {self.described()} is one key, the name of an action, not {seen}{hint}"
            )
        name = next(iter(item))
        return Entity(item[name], name, source=self.source, where=item.places[name], parent=self)

    def described(self) -> str:
        return f"'{self._name}'"

    def place(self, attribute: str | None = None) -> Place:
        places = self._element.places if isinstance(self._element, Mapping) else {}
        return self.source.path, places.get(attribute, self._where)

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        attributes = self._attributes(optional)
        self._asked.append(name)
        if name not in attributes:
            if optional:
                return None
            found = nearest_name(name, [each for each in attributes if isinstance(each, str)])
            hint = f"; it has '{found}'" if found else ""
            raise EntityError(self, f"{self.described()} lacks the key '{name}'{hint}")
        value = attributes[name]
        self.source.read = self, name
        if check_is_list_entity(data_type):
            if not isinstance(value, list) or not all(isinstance(each, Mapping) for each in value):
                raise EntityError(self, f"'{name}' of {self.described()} is {_shown(value)}, not a list of keys", name)
            where = str(self.place(name)[1])
            return [
                Entity(
                    each, name, source=self.source, where=next(iter(each.places.values()), where), parent=self
                )
                for each in value
            ]  # fmt: skip
        if not is_instance_of(value, data_type, can_be_str=can_be_str):
            wanted, hint = type_word(data_type), ""
            if value is None:
                hint = "; give it one, or leave the key out"
            elif data_type is str and isinstance(value, bool | int | float):
                hint = f"; write '{str(value).lower()}' with its quotes"
            elif data_type is float and isinstance(value, int) and not isinstance(value, bool):
                hint = f"; write {value}.0"
            elif data_type in (bool, float) and isinstance(value, str) and not can_be_str:
                hint = "; write it without quotes and substitutions"
            raise EntityError(self, f"'{name}' of {self.described()} is {_shown(value)}, not {wanted}{hint}", name)
        return value

    def _attributes(self, optional: bool) -> Any:
        if isinstance(self._element, Mapping):
            return self._element
        if optional and (isinstance(self._element, list) or self._element is None):
            return {}
        if self._element is None:
            return {}
        raise EntityError(self, f"below {self.described()} stands {_shown(self._element)}, not keys with values")

    def assert_entity_completely_parsed(self) -> None:
        """Raise EntityError for the first key that nobody has asked for, or a list that nobody has read."""
        if isinstance(self._element, list):
            if self._children is None:
                raise EntityError(self, f"{self.described()} holds no actions; its keys cannot be a list")
            return
        if not isinstance(self._element, Mapping):
            return
        for name in self._element:
            if name not in self._asked:
                hint = did_you_mean(str(name), dict.fromkeys(self._asked), listing="it can have")
                raise EntityError(self, f"{self.described()} has no key '{name}'{hint}", name)


def _shown(value: Any) -> str:
    if isinstance(value, list | Mapping):
        return "a list" if isinstance(value, list) else "a mapping"
    return "nothing" if value is None else f"{value!r}"[:60]
