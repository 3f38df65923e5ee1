"""A copy of a parameter file with other values and names.

Source: ros-navigation/navigation2 (jazzy), nav2_common/nav2_common/launch/rewritten_yaml.py
"""

from __future__ import annotations

from typing import Any

import yaml

from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from gz_course.sim.ros.nav2_common.launch.source_file import OfSourceFile, as_texts, performed, written

_PARAMETERS = "ros__parameters"


class RewrittenYaml(OfSourceFile):
    """The path of a copy of `source_file`.

    `param_rewrites` names values by their key, wherever it is, or by the whole path, as in
    `amcl.ros__parameters.base_frame_id`; a path with `ros__parameters` that the file does not have is added.
    `key_rewrites` renames keys. `root_key` is put above all, unless it is empty. `true` and `false` become booleans;
    with `convert_types` texts that look like numbers become numbers, too.
    """

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        param_rewrites: dict[str, SomeSubstitutionsType],
        root_key: SomeSubstitutionsType | None = None,
        key_rewrites: dict[str, SomeSubstitutionsType] | None = None,
        convert_types: bool = False,
    ) -> None:
        super().__init__(source_file)
        self._values = as_texts(param_rewrites)
        self._keys = as_texts(key_rewrites)
        self._root = normalize_to_list_of_substitutions("" if root_key is None else root_key)
        self._convert_types = convert_types

    def perform(self, context: LaunchContext) -> str:
        """Return the path of the copy. Raises SubstitutionFailure if the file cannot be read."""
        content = self._parameters(context)
        values = {name: self._converted(text) for name, text in performed(context, self._values).items()}
        found = _replaced(content, values, "")
        for path in values.keys() - found:
            if _PARAMETERS in path.split("."):
                _add(content, path.split("."), values[path])
        content = _renamed(content, performed(context, self._keys))
        root = perform_substitutions(context, self._root)
        return written(yaml.dump({root: content} if root else content))

    def _converted(self, text: str) -> Any:
        if self._convert_types:
            try:
                return float(text) if "." in text else int(text)
            except ValueError:
                pass
        return {"true": True, "false": False}.get(text.lower(), text)


def _replaced(value: Any, values: dict[str, Any], path: str) -> set[str]:
    """Replace the values of keys and of whole paths in dictionaries and lists; return all paths there are."""
    if not isinstance(value, dict | list):
        return {path}
    paths = set()
    for key, each in list(value.items() if isinstance(value, dict) else enumerate(value)):
        below = f"{path}.{key}" if path else str(key)
        paths |= _replaced(each, values, below)
        if isinstance(value, dict) and key in values:
            value[key] = values[key]
        if below in values and not isinstance(value[key], dict | list):
            value[key] = values[below]
    return paths


def _add(content: dict[str, Any], keys: list[str], value: Any) -> None:
    for key in keys[:-1]:
        if not isinstance(content.get(key), dict):
            content[key] = {}
        content = content[key]
    content[keys[-1]] = value


def _renamed(value: Any, keys: dict[str, str]) -> Any:
    if not isinstance(value, dict):
        return value
    return {keys.get(key, key): _renamed(each, keys) for key, each in value.items()}
