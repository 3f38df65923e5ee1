ros2 topic pub --once /model/robot/cmd_vel geometry_msgs/msg/Twist '{angular: {z: -0.5}}'
