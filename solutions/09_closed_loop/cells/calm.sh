ros2 param set /keeper gain 1.0
