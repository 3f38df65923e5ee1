driver = room.start("python3 driver.py", instead_of="python3 driver.py")
sketcher = room.start("python3 sketcher.py", instead_of="python3 sketcher.py")
