camera = room.start(
    f"{mount} --x -0.1 --z 0.25 --yaw -1.5708 --frame-id robot --child-frame-id robot/camera",
    instead_of=mount,
)
