"""Explanations of errors of Python and rclpy, by what they are about; used by `grader/score/python_errors.py`."""
