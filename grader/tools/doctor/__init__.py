"""The implementation of `course doctor`: its questions are in `checks/`, and `checkup.py` asks them all."""
