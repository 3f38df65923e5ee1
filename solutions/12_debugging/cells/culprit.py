culprit = "ros_gz_bridge"
