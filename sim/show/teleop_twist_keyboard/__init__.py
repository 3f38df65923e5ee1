"""`ros2 run teleop_twist_keyboard teleop_twist_keyboard`: drives a robot with the keys of a terminal.

`keys.py` turns keys into velocities, `terminal.py` reads them one by one, `teleop_twist_keyboard.py` publishes.
"""
