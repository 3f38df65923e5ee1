"""The agent: code in the submission's processes that watches them from within and reports to the grader.

It imports nothing of the grader, and the grader does not trust its reports. `import_hooks.py` is called at every start
of Python. `python_3*.py` and `rclpy_7_1*.py` hold all patches; `executor_monitor.py` counts and reports what they see,
`held_messages.py` holds what is sent until the grader releases it, `thread_monitor.py` knows which threads are at work
and which sleep, `inbox.py` keeps messages for nodes that sleep.
`run_node.py` runs a submitted file. `channel.py` is the connection to the grader. `remote_*.py` replace those parts of
Gazebo's programs that the grader simulates (`grader_requests.py`).
"""
