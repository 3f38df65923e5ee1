"""Works with a running Gazebo world from ROS 2, standing where the ``ros_gz_sim`` package stands.

Contents: the executables ``create``, ``remove``, ``spawn_entity``, ``delete_entity``, ``set_entity_pose`` and
``gzserver``, and what they share: ``flags`` (options and parameters), ``running_world`` (Gazebo's services, with a
deadline). The launch files are in ``prefix/share/ros_gz_sim``.
"""
