"""Publishes a robot's description and where its links are, in place of the ``robot_state_publisher`` package.

Contents: ``kinematics`` (a URDF and joint positions become transforms), ``publisher`` (topics and parameters) and the
executable ``robot_state_publisher``.
"""
