"""Filters for streams of messages, in place of the `message_filters` package of ROS 2.

A filter takes messages from a subscription or from another filter and passes them on to its callbacks, for instance
pairs of messages with equal stamps.

Source: Python API of message_filters 4.11 (Jazzy), https://github.com/ros2/message_filters/tree/jazzy
"""

from gz_course.sim.ros.message_filters.approximate_time_synchronizer import ApproximateTimeSynchronizer
from gz_course.sim.ros.message_filters.cache import Cache
from gz_course.sim.ros.message_filters.chain import Chain
from gz_course.sim.ros.message_filters.simple_filter import SimpleFilter
from gz_course.sim.ros.message_filters.subscriber import Subscriber
from gz_course.sim.ros.message_filters.time_synchronizer import TimeSynchronizer

__all__ = ["ApproximateTimeSynchronizer", "Cache", "Chain", "SimpleFilter", "Subscriber", "TimeSynchronizer"]
