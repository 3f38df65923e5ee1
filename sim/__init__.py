"""The tools of Gazebo and ROS 2: each package stands where the package of its name stands on a full installation."""
