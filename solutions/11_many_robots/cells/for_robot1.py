spinner = room.start("python spinner.py --ros-args -r __ns:=/robot1", instead_of="python spinner.py")
spinner.wait_for("ready")
