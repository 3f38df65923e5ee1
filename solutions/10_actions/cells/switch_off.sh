ros2 service call /drive std_srvs/srv/SetBool '{data: false}'
