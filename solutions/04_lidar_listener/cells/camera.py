argument = "/camera/image@sensor_msgs/msg/Image[gz.msgs.Image"
rename = "/camera/image:=/image"
command = "ros2 run ros_gz_bridge parameter_bridge --ros-args -r __node:=camera_bridge"
camera = room.start(f"{command} -r {rename} -- '{argument}'", instead_of=command)
