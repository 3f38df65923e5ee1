"""The bridge between Gazebo topics and ROS 2 topics, standing where the ``ros_gz_bridge`` package stands.

Contents: ``entry`` (what one bridge is); ``config``, ``arguments`` and ``parameters`` (the three ways to write it down:
YAML, command line, ROS parameters), which read keys with ``entry_reader`` and look for trouble with ``checks``;
``type_pairs`` and ``convert`` (which message becomes which); ``bridge``, ``link``, ``lane`` and ``service_link`` (the
running bridge); ``parameter_bridge`` and ``lint`` (the commands; ``ros_program`` is what such have in common),
``watch`` (what a running bridge notices), ``shared_memory`` (room for pictures).
"""
