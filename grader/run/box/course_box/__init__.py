"""What runs in the submission's own processes: it imports nothing of the grader, and nothing of it is trusted.

`hooks.py` is called at every start of Python. `participant.py` watches rclpy and reports; `node.py` runs a submitted
file. `channel.py` is the way to the grader.
"""
