"""The helper: a process that has done the imports of a grading, waits for the next one, and ends when none comes.

`client.py` is the command's side, `waiting_process.py` the process, `place.py` says where the two meet, `order.py` what
goes between them. A grading is a fork of the helper, which never reads a submission and holds nothing of one.
"""
