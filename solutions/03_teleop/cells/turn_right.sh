ros2 topic pub --once /cmd_vel geometry_msgs/msg/Twist '{angular: {z: -0.5}}'
