"""Programs that work with a running Gazebo world, in place of the `ros_gz_sim` package.

Contents: the executables `create`, `remove`, `spawn_entity`, `delete_entity`, `set_entity_pose` and `gzserver`; `flags`
(options and parameters) and `running_world` (Gazebo's services, with a deadline); `actions` of launch files. The launch
files are in `prefix/share/ros_gz_sim`.

Source: README.md and src/*.cpp of ros_gz_sim, https://github.com/gazebosim/ros_gz/tree/jazzy/ros_gz_sim
"""
