gz topic -e -t /imu -n 1
