"""The bridge between Gazebo topics and ROS 2 topics, in place of the `ros_gz_bridge` package.

Contents: `entry` (one bridge as data); `config`, `arguments` and `parameters` (its three notations: YAML, command line,
ROS parameters), which read keys with `entry_reader` and look for mistakes with `checks`; `type_pairs`, `fields` and
`convert` (the conversions); `bridge`, `link`, `worker` and `service_link` (the running bridge) and `watch` (its
warnings); `parameter_bridge`, `lint` and `bridge_types` (the programs).

Source: README.md of ros_gz_bridge, https://github.com/gazebosim/ros_gz/tree/jazzy/ros_gz_bridge
"""
