"""Substitutions that find ROS packages and their files."""

from gz_course.sim.launch.frontend import expose_substitution
from gz_course.sim.launch_ros.substitutions.executable_in_package import ExecutableInPackage
from gz_course.sim.launch_ros.substitutions.find_package import FindPackage, FindPackagePrefix, FindPackageShare

expose_substitution("find-pkg-prefix", 1, 1, FindPackagePrefix)
expose_substitution("find-pkg-share", 1, 1, FindPackageShare)
expose_substitution("exec-in-pkg", 2, 2, lambda executable, package: ExecutableInPackage(executable, package))

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare"]
