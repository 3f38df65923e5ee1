command = "ros2 run ros_gz_bridge parameter_bridge --ros-args -r __node:=imu_bridge --"
argument = "/imu@sensor_msgs/msg/Imu[gz.msgs.IMU"
imu_bridge = room.start(f"{command} '{argument}'", instead_of=command)
