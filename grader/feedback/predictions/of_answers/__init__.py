"""Explanations of numbers that answer scans; registered in `answers.py`."""
