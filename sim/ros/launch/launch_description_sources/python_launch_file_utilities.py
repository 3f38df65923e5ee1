"""The loader of Python launch files: a function `generate_launch_description()` that returns a LaunchDescription."""

from __future__ import annotations

import os
from pathlib import Path
from types import ModuleType

from gz_course.sim.did_you_mean import did_you_mean, nearest_name
from gz_course.sim.ros.launch.ament_prefix import packages_with_launch_file
from gz_course.sim.ros.launch.invalid_launch_file_error import InvalidLaunchFileError
from gz_course.sim.ros.launch.launch_description import LaunchDescription

_FUNCTION = "generate_launch_description"


class InvalidPythonLaunchFileError(InvalidLaunchFileError):
    """A Python file is missing or is no launch file."""


def load_python_launch_file_as_module(python_launch_file_path: str) -> ModuleType:
    """Execute a Python launch file; return it as a module that is not in `sys.modules`.

    Raises InvalidPythonLaunchFileError if it cannot be read, SyntaxError, and the errors of its code.
    """
    path = Path(python_launch_file_path)
    try:
        source = path.read_bytes()
    except (OSError, ValueError) as error:
        raise InvalidPythonLaunchFileError(why_not_readable(path, error)) from None
    module = ModuleType("python_launch_file")
    module.__file__ = str(path)
    try:
        code = compile(source, str(path), "exec")
    except (SyntaxError, ValueError) as error:
        if source.lstrip().startswith(b"<"):
            raise InvalidPythonLaunchFileError(
                f"{path}: this is XML, not Python; name it .launch.xml, and include it with AnyLaunchDescriptionSource"
            ) from None
        if isinstance(error, SyntaxError) and error.filename:
            raise
        # for example null bytes
        raise InvalidPythonLaunchFileError(f"{path}: this is no Python file: {error}") from None
    exec(code, module.__dict__)
    return module


def get_launch_description_from_python_launch_file(python_launch_file_path: str) -> LaunchDescription:
    """Return the result of generate_launch_description() of a file.

    Raises InvalidPythonLaunchFileError if the function is missing or returns no LaunchDescription, and the errors of
    load_python_launch_file_as_module and of the function.
    """
    module = load_python_launch_file_as_module(python_launch_file_path)
    function = getattr(module, _FUNCTION, None)
    if not callable(function):
        own = [name for name, value in vars(module).items() if getattr(value, "__module__", "") == module.__name__]
        raise InvalidPythonLaunchFileError(
            f"launch file at '{python_launch_file_path}' does not contain the required function "
            f"'{_FUNCTION}()'{_instead(own)}"
        )
    description = function()
    if not isinstance(description, LaunchDescription):
        hint = "; its `return` is missing" if description is None else ""
        if isinstance(description, list | tuple):
            hint = "; write return LaunchDescription([...])"
        raise InvalidPythonLaunchFileError(
            f"{_FUNCTION}() in '{python_launch_file_path}' returned {_described(description)}, not a "
            f"LaunchDescription{hint}"
        )
    return description


def _instead(own: list[str]) -> str:
    """Return the end of a sentence on a function whose name is nearly the required one."""
    near = nearest_name(_FUNCTION, own)
    return f"; its function '{near}' has another name" if near else ""


def _described(value: object) -> str:
    """Return a short description of a value, because a list of actions would fill the screen."""
    text = repr(value)
    return f"{text} of type {type(value).__name__}" if len(text) <= 60 else f"a {type(value).__name__}"


def why_not_readable(path: Path, error: OSError | ValueError) -> str:
    """Return why a launch file cannot be read, in one sentence."""
    if not isinstance(error, FileNotFoundError):
        return f"the launch file '{path}' cannot be read: {getattr(error, 'strerror', None) or error}"
    sentence = f"there is no launch file '{path}'"
    if not path.is_absolute():
        sentence += f" in the current folder {Path.cwd()}"
    folder = path.parent if path.parent.is_dir() else None
    sentence += did_you_mean(path.name, os.listdir(folder)) if folder else ""  # noqa: PTH208
    return sentence + _a_package_has(path)


def _a_package_has(path: Path) -> str:
    """Return the end of an error sentence: how to refer to a file name that a ROS package has."""
    if path.parent != Path():
        return ""
    found = packages_with_launch_file(path.name)
    if not found:
        return ""
    return (
        f"; the package {found[0]} has one of that name: write "
        f'PathJoinSubstitution([FindPackageShare("{found[0]}"), "launch", "{path.name}"])'
    )
