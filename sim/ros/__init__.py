"""The ROS side: packages that have the name and the content of a package of a full ROS 2 installation."""
