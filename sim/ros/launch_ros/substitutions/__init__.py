"""Substitutions that find ROS packages and their files, and parameters of the scope."""

from gz_course.sim.ros.launch.frontend.expose import add_substitution
from gz_course.sim.ros.launch_ros.substitutions.executable_in_package import ExecutableInPackage
from gz_course.sim.ros.launch_ros.substitutions.find_package import FindPackage, FindPackagePrefix, FindPackageShare
from gz_course.sim.ros.launch_ros.substitutions.parameter import Parameter

add_substitution("find-pkg-prefix", 1, 1, FindPackagePrefix)
add_substitution("find-pkg-share", 1, 1, FindPackageShare)
add_substitution("exec-in-pkg", 2, 2, lambda executable, package: ExecutableInPackage(executable, package))
add_substitution("param", 1, 1, Parameter)

__all__ = ["ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare", "Parameter"]
