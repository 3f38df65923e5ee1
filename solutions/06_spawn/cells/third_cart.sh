ros2 run ros_gz_sim create -file level.sdf -name third -x 1 -y -1 -z 0.01 -Y 1.5708
