"""Launch tests with ROS nodes: waiting for topics, republished messages, a node that spins in a thread.

Source: https://github.com/ros2/launch_ros, launch_testing_ros
"""

from gz_course.sim.ros.launch_testing_ros import tools
from gz_course.sim.ros.launch_testing_ros.data_republisher import DataRepublisher
from gz_course.sim.ros.launch_testing_ros.message_pump import MessagePump
from gz_course.sim.ros.launch_testing_ros.test_runner import LaunchTestRunner
from gz_course.sim.ros.launch_testing_ros.wait_for_topics import WaitForTopics

__all__ = ["DataRepublisher", "LaunchTestRunner", "MessagePump", "WaitForTopics", "tools"]
