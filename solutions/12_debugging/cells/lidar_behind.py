frame = room.start(
    "ros2 run tf2_ros static_transform_publisher " + "--x -0.2 --frame-id base_link --child-frame-id lidar_link",
    instead_of="ros2 run tf2_ros",
)
frame.wait_for("Spinning")
