ros2 param set /circler speed 0.3
