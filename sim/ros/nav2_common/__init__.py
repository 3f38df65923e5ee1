"""What launch files use of Navigation2, in place of the package `nav2_common` of ROS 2: `nav2_common.launch`."""
