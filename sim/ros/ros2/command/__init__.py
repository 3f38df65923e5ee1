"""Look at and work with a running ROS 2 system."""
