"""Parameters of nodes: values of a given type, single parameters, parameter files."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path
from typing import Any

from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.frontend import parse_substitution
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from gz_course.sim.ros.launch_ros.parameter_values import (
    TypedValue,
    Value,
    check_type,
    check_value,
    coerce,
    evaluate_value,
)


class ParameterValue(TypedValue):
    """A value of a given type: `value_type` is str, int, float, bool or List[...] of one of them.

    Without a type it is the value itself. A substitution, such as `Command`, is converted to the type; its text is
    parsed as YAML unless that is str. Any other value must have the type: ParameterTypeError (a TypeError) for `'3'`
    with int.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.__value = value
        self.value_type = value_type
        if not (isinstance(value, list | tuple) and any(isinstance(item, Substitution) for item in value)):
            check_value("ParameterValue", value)
            if value_type is not None:
                check_type(value, value_type)

    @property
    def value(self) -> Any:
        return self.__value

    def evaluate(self, context: LaunchContext, name: str = "") -> Value:
        """Return the value for the node. Raises ParameterTypeError (a TypeError)."""
        if self.value_type is None:
            return evaluate_value(context, name, self.__value)
        value = self.__value
        if isinstance(value, Substitution) or (
            isinstance(value, list | tuple) and any(isinstance(item, Substitution) for item in value)
        ):
            value = perform_substitutions(context, normalize_to_list_of_substitutions(value))
        elif isinstance(value, list | tuple):
            value = [
                perform_substitutions(context, normalize_to_list_of_substitutions(item))
                if isinstance(item, list | tuple)
                else item
                for item in value
            ]
        return coerce(name, value, self.value_type)


class Parameter:
    """One parameter: its name, its value, and optionally the type of the value."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self.__name = normalize_to_list_of_substitutions(name)
        self.__value = ParameterValue(value, value_type=value_type)

    @property
    def name(self) -> list[Substitution]:
        return self.__name

    @property
    def value(self) -> Any:
        return self.__value.value

    @property
    def value_type(self) -> Any:
        return self.__value.value_type

    def evaluate(self, context: LaunchContext) -> tuple[str, Value]:
        name = perform_substitutions(context, self.__name)
        return name, self.__value.evaluate(context, name)


class ParameterFile:
    """A parameter file; with `allow_substs` it may contain `$(var name)` and other substitutions."""

    def __init__(
        self,
        param_file: SomeSubstitutionsType | os.PathLike[str],
        *,
        allow_substs: bool | SomeSubstitutionsType = False,
    ) -> None:
        self.param_file = normalize_to_list_of_substitutions(param_file)
        self.allow_substs = normalize_to_list_of_substitutions(
            str(allow_substs) if isinstance(allow_substs, bool) else allow_substs
        )
        self.__made: Path | None = None

    def evaluate(self, context: LaunchContext) -> Path:
        """Return the path of the file, or of a new one with the substitutions performed."""
        import yaml

        from gz_course.sim.ros.launch.conditions import evaluate_condition_expression

        path = Path(perform_substitutions(context, self.param_file))
        if not evaluate_condition_expression(context, self.allow_substs) or not path.is_file():
            return path
        source = path.read_text(encoding="utf-8")
        try:
            # Comments may contain invalid substitutions; loading the YAML removes them.
            plain = yaml.safe_dump(yaml.safe_load(source), width=float("inf"))
            text = perform_substitutions(context, parse_substitution(plain))
            yaml.safe_load(text)
        except yaml.YAMLError as error:
            raise LaunchError(f"the parameter file '{path}' is no YAML: {_one_line(error)}") from None
        self.cleanup()
        self.__made = write_parameter_file(text)
        return self.__made

    def cleanup(self) -> None:
        if self.__made is not None:
            with contextlib.suppress(FileNotFoundError):
                self.__made.unlink()
            self.__made = None


def write_parameter_file(text: str) -> Path:
    """Write a temporary parameter file; return its path."""
    descriptor, path = tempfile.mkstemp(prefix="launch_params_")
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        file.write(text)
    return Path(path)


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split())
