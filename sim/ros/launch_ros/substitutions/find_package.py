"""The substitutions for the folders of a ROS package."""

from __future__ import annotations

from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_prefix

from gz_course.sim.ros.launch.ament_prefix import nearest_package_of
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.substitutions import PathJoinSubstitution, SubstitutionFailure
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class FindPackage(Substitution):
    """Base of substitutions for a folder of `package`."""

    def __init__(self, package: SomeSubstitutionsType) -> None:
        self.package = normalize_to_list_of_substitutions(package)

    def find(self, package_name: str) -> str:
        return package_prefix(package_name)

    def __truediv__(self, component: SomeSubstitutionsType) -> PathJoinSubstitution:
        return PathJoinSubstitution([self, component])

    def describe(self) -> str:
        return f"{type(self).__name__}(pkg={describe_substitutions(self.package)})"

    def perform(self, context: LaunchContext) -> str:
        return self.find(perform_substitutions(context, self.package))


class FindPackagePrefix(FindPackage):
    """The prefix that a package is installed in."""


class FindPackageShare(FindPackage):
    """The share folder of a package: launch files, worlds, configurations."""

    def find(self, package_name: str) -> str:
        return str(Path(package_prefix(package_name)) / "share" / package_name)


def package_prefix(package_name: str) -> str:
    """Return the prefix that a package is installed in. Raises SubstitutionFailure."""
    try:
        return get_package_prefix(package_name)
    except PackageNotFoundError as error:
        sentence = str(error.args[0])
        raise SubstitutionFailure(sentence + nearest_package_of(sentence)) from None
    except ValueError as error:  # an invalid package name
        raise SubstitutionFailure(str(error)) from None
    except OSError:
        raise SubstitutionFailure(
            f"package '{package_name}' not found: AMENT_PREFIX_PATH, which names the folders to search, is not set"
        ) from None
