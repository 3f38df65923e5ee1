"""The tools of Gazebo and ROS 2. Each package has the name and the content of a package of a full installation."""
