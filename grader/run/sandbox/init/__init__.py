"""What runs inside a box, between its walls going up and the submission's start; imports nothing else of the grader.

Every millisecond here is paid by every grading, hence few and small modules: no pathlib, json, contextlib or typing.
"""
