"""Values that are known now or given by substitutions: their types, and conversions of text.

Source: ros2/launch, launch/launch/utilities/type_utils.py
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, List, get_args, get_origin  # noqa: UP035 - `List[int]` is part of the interface

from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.utilities.normalize_to_list_of_substitutions_impl import (
    normalize_to_list_of_substitutions,
)
from gz_course.sim.ros.launch.utilities.perform_substitutions_impl import perform_substitutions

ScalarTypesTuple = (int, float, bool, str)
ListTypesTuple = (List[int], List[float], List[bool], List[str])  # noqa: UP006
AllowedTypesTuple = ScalarTypesTuple + ListTypesTuple
ScalarTypesType = type[int] | type[float] | type[bool] | type[str]
ListTypesType = type[list[int]] | type[list[float]] | type[list[bool]] | type[list[str]]
AllowedTypesType = ScalarTypesType | ListTypesType
ScalarValueType = int | float | bool | str
ListValueType = list[int] | list[float] | list[bool] | list[str]
AllowedValueType = ScalarValueType | ListValueType
SomeScalarType = Any
SomeValueType = Any
NormalizedScalarType = list[Substitution] | ScalarValueType
NormalizedValueType = Any
SomeSubstitutions = SomeSubstitutionsType
_BOOLS = {"true": True, "yes": True, "on": True, "1": True, "false": False, "no": False, "off": False, "0": False}


def is_typing_list(data_type: Any) -> bool:
    """Return whether this is List or List[...]."""
    return data_type in (List, list) or get_origin(data_type) is list  # noqa: UP006


def is_valid_scalar_type(data_type: Any) -> bool:
    return data_type in ScalarTypesTuple


def extract_type(data_type: Any) -> tuple[Any, bool]:
    """Return the type, or that of the items, and whether it is a list. Raises ValueError for any other type."""
    is_list = get_origin(data_type) is list
    scalar = get_args(data_type)[0] if is_list else data_type
    if scalar not in ScalarTypesTuple:
        raise ValueError(f"{data_type!r} is no type of values; int, float, bool, str and List[...] of them are")
    return scalar, is_list


def type_word(data_type: Any) -> str:
    """Return a type in words, for errors."""
    if data_type is None:
        return "a bool, int, float, text or a list of one of them"
    scalar, is_list = extract_type(data_type)
    words = {str: "text", bool: "true or false", int: "a whole number", float: "a number with a point"}
    return f"a list whose items are {words[scalar]}" if is_list else words[scalar]


def is_instance_of_valid_type(value: Any, can_be_str: bool = False) -> bool:
    """Return whether this is a scalar or a list of one type; with `can_be_str` some items may be text."""
    if not isinstance(value, list):
        return isinstance(value, ScalarTypesTuple)
    kinds = {type(item) for item in value} - ({str} if can_be_str else set())
    return len(kinds) <= 1 and kinds <= set(ScalarTypesTuple)


def is_instance_of(value: Any, data_type: Any = None, can_be_str: bool = False) -> bool:
    """Return whether a value is of this type, None for any valid one; with `can_be_str` also text."""
    if data_type is None:
        return is_instance_of_valid_type(value, can_be_str)
    scalar, is_list = extract_type(data_type)
    kinds = (scalar, str) if can_be_str else (scalar,)
    if is_list:
        return isinstance(value, list) and all(isinstance(item, kinds) for item in value)
    return isinstance(value, kinds)


def coerce_to_type(value: str, data_type: Any = None, can_be_str: bool = False) -> Any:
    """Convert text to a type, None for what it is in YAML; with `can_be_str` text that is no such value stays text.

    Raises ValueError if that is impossible.
    """
    if not isinstance(value, str):
        raise TypeError(f"{value!r} is not text")
    if data_type is str:
        return value
    if data_type is bool and value.strip().lower() in _BOOLS:
        return _BOOLS[value.strip().lower()]
    if data_type in (int, float):
        try:
            return data_type(value)
        except ValueError:
            if can_be_str:
                return value
            raise
    read = _from_yaml(value, can_be_str)
    if data_type is None and read is None and can_be_str:
        return value
    whole_text = can_be_str and isinstance(read, str) and not is_typing_list(data_type)
    if not (whole_text or is_instance_of(read, data_type, can_be_str)):
        raise ValueError(f"{value!r} is not {type_word(data_type)}")
    return read


def _from_yaml(text: str, can_be_str: bool) -> Any:
    import yaml  # slow to import, and not needed by most launch files

    try:
        return yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        if can_be_str:
            return text
        raise ValueError(f"{text!r} is no YAML: {' '.join(str(error).split())}") from None


def coerce_list(value: list[str], data_type: Any = None, can_be_str: bool = False) -> list[Any]:
    """Convert the texts of a list to one type. Raises ValueError."""
    if not isinstance(value, list):
        raise TypeError(f"{value!r} is not a list")
    result = [coerce_to_type(item, data_type, can_be_str) for item in value]
    if not is_instance_of_valid_type(result, can_be_str):
        raise ValueError(f"{value!r} is not {type_word(data_type)}")
    return result


def get_typed_value(value: str | list[str], data_type: Any, can_be_str: bool = False) -> Any:
    """Convert a text, or the texts of a list. Raises ValueError, and TypeError for a list where none is wanted."""
    if not isinstance(value, list):
        return coerce_to_type(value, data_type, can_be_str)
    scalar, is_list = (None, True) if data_type is None else extract_type(data_type)
    if not is_list:
        raise TypeError(f"{value!r} is a list, not {type_word(data_type)}")
    return coerce_list(value, scalar, can_be_str)


def is_substitution(value: Any) -> bool:
    """Return whether this is a substitution, or a list of text and at least one substitution."""
    if isinstance(value, Substitution):
        return True
    if isinstance(value, str) or not isinstance(value, Iterable):
        return False
    items = list(value)
    return any(isinstance(item, Substitution) for item in items) and all(
        isinstance(item, str | Substitution) for item in items
    )


def is_normalized_substitution(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(item, Substitution) for item in value)


def normalize_typed_substitution(value: Any, data_type: Any = None) -> Any:
    """Return a value of this type as it is, substitutions as a list of them. Raises TypeError for anything else."""
    if isinstance(value, ScalarTypesTuple):
        if not is_instance_of(value, data_type):
            raise TypeError(f"{value!r} is not {type_word(data_type)}")
        return value
    if is_substitution(value):
        return normalize_to_list_of_substitutions(value)
    if not isinstance(value, Iterable):
        raise TypeError(f"{value!r} is neither a value nor a substitution")
    items: list[Any] = [normalize_to_list_of_substitutions(item) if is_substitution(item) else item for item in value]
    plain = [item for item in items if not is_normalized_substitution(item)]
    if {type(item) for item in plain} == {int, float}:
        items = [float(item) if isinstance(item, int) else item for item in items]
        plain = [float(item) for item in plain]
    if not is_instance_of(plain, data_type):
        raise TypeError(f"{value!r} is not {type_word(data_type)}")
    return items


def perform_typed_substitution(context: LaunchContext, value: Any, data_type: Any = None) -> Any:
    """Perform a result of normalize_typed_substitution, and convert its text to the type. Raises ValueError."""
    if is_normalized_substitution(value):
        return coerce_to_type(perform_substitutions(context, value), data_type)
    if not isinstance(value, list):
        return normalize_typed_substitution(value, data_type)
    scalar = None if data_type is None else extract_type(data_type)[0]
    return [
        coerce_to_type(perform_substitutions(context, item), scalar) if is_normalized_substitution(item) else item
        for item in value
    ]
