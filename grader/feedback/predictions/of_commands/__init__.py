"""Explanations of sequences of velocity commands; registered in `commands.py`."""
