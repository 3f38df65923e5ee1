"""The files of a new ROS package, as `ros2 pkg create` makes them.

Source: ros2pkg 0.32 (`resource/`: which files a package of each build type has); their content is the course's own
"""
