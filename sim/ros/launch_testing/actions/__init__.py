"""Actions of launch tests."""

from gz_course.sim.ros.launch_testing.actions.gtest import GTest
from gz_course.sim.ros.launch_testing.actions.pytest import PyTest
from gz_course.sim.ros.launch_testing.actions.ready import ReadyToTest
from gz_course.sim.ros.launch_testing.actions.test import Test

__all__ = ["GTest", "PyTest", "ReadyToTest", "Test"]
