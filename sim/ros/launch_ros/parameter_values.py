"""The types of parameter values in a launch file.

    'text'                           text, also '5'
    True, 3, 0.5                     unchanged
    [1, 2.5]                         a list of one type; integers beside floats become floats
    LaunchConfiguration('x')         text, parsed as YAML: 3 is a number, true a boolean, [1, 2] a list
    ['a', LaunchConfiguration('x')]  one joined text, parsed as YAML
    [['a'], [LaunchConfiguration('x')]]   a list; each item is joined and parsed as YAML
    ParameterValue(x, value_type=T)  of type T

Source: ros2/launch_ros, launch_ros/launch_ros/utilities/normalize_parameters.py and evaluate_parameters.py
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, get_args, get_origin

from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

SCALARS = (bool, int, float, str)
Value = bool | int | float | str | list[bool] | list[int] | list[float] | list[str]


class ParameterTypeError(LaunchError, TypeError):
    """A value that cannot be the value of a parameter."""


class TypedValue:
    """A value that has a type of its own, as a `ParameterValue` has."""

    def evaluate(self, context: LaunchContext, name: str = "") -> Value:
        """Return the value for the node. Raises ParameterTypeError (a TypeError)."""
        raise NotImplementedError


def check_value(name: str, value: Any) -> None:
    """Raise ParameterTypeError for a value that cannot be a parameter, as far as that is known before the launch."""
    if isinstance(value, Mapping):
        for key, each in value.items():
            check_value(f"{name}.{key}", each)
    elif isinstance(value, (TypedValue, Substitution, os.PathLike, *SCALARS)):
        return
    elif isinstance(value, Sequence) and not isinstance(value, bytes):
        if not any(isinstance(item, Substitution | list | tuple) for item in value):
            uniform(name, value)
    else:
        raise ParameterTypeError(
            f"the parameter '{name}' has the value {value!r} of type {type(value).__name__}; a bool, int, float, text, "
            "a list of one of these, or a substitution is expected"
        )


def check_type(value: Any, value_type: Any) -> None:
    """Raise ParameterTypeError if a value that needs no conversion, such as `3`, is not of the type given with it."""
    items, item_type = [value], value_type
    if isinstance(value, Substitution | Mapping):
        return
    if isinstance(value, list | tuple) and get_origin(value_type) is not list:
        if value_type in SCALARS and not any(isinstance(item, Substitution) for item in value):
            raise _not_of_type("", value, value_type)
    elif isinstance(value, list | tuple):
        plain = [item for item in value if not isinstance(item, Substitution | list | tuple)]
        items, item_type = uniform("ParameterValue", plain) if plain else [], get_args(value_type)[0]
    if item_type not in SCALARS:
        raise _not_of_type("", value, value_type) if get_origin(value_type) is list else _no_type("", value_type)
    if not all(isinstance(item, item_type | Substitution | list | tuple) for item in items):
        error = _not_of_type("", value, value_type)
        raise ParameterTypeError(f"{error}; only substitutions are converted")


def evaluate_value(context: LaunchContext, name: str, value: Any) -> Value:
    """Return the value for the node. Raises ParameterTypeError."""
    if isinstance(value, TypedValue):
        return value.evaluate(context, name)
    if isinstance(value, SCALARS):
        return value
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Substitution) or _is_one_text(value):
        return from_yaml(name, perform_substitutions(context, normalize_to_list_of_substitutions(value)))
    check_value(name, value)
    return uniform(name, [_evaluate_item(context, name, item) for item in value])


def _is_one_text(value: Any) -> bool:
    """Return whether a value is a list of text and substitutions that form one text."""
    return (
        isinstance(value, Sequence)
        and any(isinstance(item, Substitution) for item in value)
        and all(isinstance(item, str | Substitution) for item in value)
    )


def _evaluate_item(context: LaunchContext, name: str, item: Any) -> Any:
    if isinstance(item, list | tuple):
        return from_yaml(name, perform_substitutions(context, normalize_to_list_of_substitutions(item)))
    return item


def from_yaml(name: str, text: str) -> Value:
    """Parse a text as YAML. Raises ParameterTypeError if no parameter can have this value."""
    import yaml  # slow to import, and not needed by most launch files

    if text == "":
        return ""
    advice = f"; if it is meant as text, wrap it: '{name}': ParameterValue(..., value_type=str)"
    shown = text if len(text) <= 60 else f"{text[:60]}..."
    try:
        value = yaml.safe_load(text)
    except yaml.YAMLError:
        raise ParameterTypeError(f"the value {shown!r} of the parameter '{name}' is no YAML{advice}") from None
    if isinstance(value, SCALARS):
        return value
    if not isinstance(value, list):
        what = "nothing" if value is None else f"a {type(value).__name__}"
        raise ParameterTypeError(
            f"the value {shown!r} of the parameter '{name}' means {what} in YAML, which no parameter can be{advice}"
        )
    if len({type(item) for item in value}) > 1:
        raise ParameterTypeError(
            f"the value {shown!r} of the parameter '{name}' is a list of several types; one is allowed{advice}"
        )
    return uniform(name, value)


def uniform(name: str, items: Iterable[Any]) -> Any:
    """Return items of one type as a list; integers beside floats become floats."""
    values = list(items)
    if not values:
        raise ParameterTypeError(f"the parameter '{name}' is an empty list; ROS cannot tell its type, leave it out")
    kinds = {kind for value in values for kind in [next((k for k in SCALARS if isinstance(value, k)), type(value))]}
    if kinds == {int, float}:
        return [float(value) for value in values]
    if len(kinds) > 1 or not kinds <= set(SCALARS):
        names = ", ".join(sorted(kind.__name__ for kind in kinds))
        raise ParameterTypeError(
            f"the parameter '{name}' is a list of {names}: {values!r}; all items must be bool, all int, all float or "
            "all text"
        )
    return values


def coerce(name: str, value: Any, value_type: Any) -> Value:
    """Convert a value to the type that ParameterValue names. Raises ParameterTypeError."""
    if get_origin(value_type) is list:
        item_type = get_args(value_type)[0]
        if isinstance(value, str):
            value = from_yaml(name, value)
        if not isinstance(value, list | tuple):
            raise _not_of_type(name, value, value_type)
        return uniform(name, [coerce(name, item, item_type) for item in value])
    if value_type not in SCALARS:
        raise _no_type(name, value_type)
    if value_type is str:
        return value if isinstance(value, str) else str(value)
    read = from_yaml(name, value) if isinstance(value, str) else value
    if value_type is float and isinstance(read, int) and not isinstance(read, bool):
        return float(read)
    if type(read) is not value_type:
        raise _not_of_type(name, value, value_type)
    return read


def _not_of_type(name: str, value: Any, value_type: Any) -> ParameterTypeError:
    wanted = getattr(value_type, "__name__", str(value_type)) if get_origin(value_type) is None else str(value_type)
    whose = f" of the parameter '{name}'" if name else " of ParameterValue"
    return ParameterTypeError(f"the value {value!r}{whose} is no {wanted}, which value_type asks for")


def _no_type(name: str, value_type: Any) -> ParameterTypeError:
    whose = f" of the parameter '{name}'" if name else ""
    return ParameterTypeError(
        f"value_type={value_type!r}{whose} is no type of parameters; bool, int, float, str and List[...] of them are"
    )


def flattened(context: LaunchContext, parameters: Mapping[Any, Any], prefix: str = "") -> dict[str, Value]:
    """Return the evaluated values by name; names of nested dicts are joined with dots."""
    result: dict[str, Value] = {}
    for key, value in parameters.items():
        name = prefix + perform_substitutions(context, normalize_to_list_of_substitutions(key))
        if isinstance(value, Mapping):
            result |= flattened(context, value, f"{name}.")
        else:
            result[name] = evaluate_value(context, name, value)
    return result


def as_argument(value: Value) -> str:
    """Return a value as YAML in flow style, for `-p name:=value`."""
    import yaml

    text = yaml.safe_dump(value, default_flow_style=True, width=float("inf"), allow_unicode=True)
    return text.removesuffix("...\n").strip()


def as_file(node: str, parameters: Mapping[str, Value]) -> str:
    """Return the text of a parameter file for the node of this full name, or `/**` for every node."""
    import yaml

    content = {node: {"ros__parameters": dict(sorted(parameters.items()))}}
    return yaml.safe_dump(content, default_flow_style=False, width=float("inf"), allow_unicode=True)
