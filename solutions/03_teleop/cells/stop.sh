ros2 topic pub --once /cmd_vel geometry_msgs/msg/Twist '{}'
