"""The bridge between Gazebo topics and ROS 2 topics, standing where the ``ros_gz_bridge`` package stands.

Contents: ``entry`` (what one bridge is), ``config`` (YAML and command-line syntax), ``type_pairs`` and
``convert`` (which message becomes which), ``bridge`` and ``link`` (the running bridge), ``parameter_bridge``
(the command).
"""
