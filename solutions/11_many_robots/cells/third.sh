ros2 run ros_gz_sim create -file ../../exercises/11_many_robots/robot.sdf -name robot3 -x -1.2 -y 1.2 -z 0.01
