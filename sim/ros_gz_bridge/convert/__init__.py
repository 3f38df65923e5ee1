"""Conversions, one file or folder for each ROS message package, named like it; `type_pairs` finds them here.

Which types pair, and how their fields correspond, is as in ros_gz_bridge. What a field means and its unit are in the
`.msg` and `.srv` files of the ROS package and in the `.proto` files of gz-msgs.

Source: README.md and src/convert/*.cpp of ros_gz_bridge, https://github.com/gazebosim/ros_gz/tree/jazzy/ros_gz_bridge
"""
