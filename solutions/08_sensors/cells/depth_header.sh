ros2 topic echo --once --no-arr --qos-reliability best_effort /depth/image
