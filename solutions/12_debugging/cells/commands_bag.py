get_ipython().system("rm -rf runs/commands")
recorder = room.start("ros2 bag record -o runs/commands /cmd_vel", instead_of="ros2 bag")
recorder.wait_for("Subscribed to topic")
for _ in range(2):
    get_ipython().system("ros2 topic echo --once --field linear.x /cmd_vel")
recorder.stop()
