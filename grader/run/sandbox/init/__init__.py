"""The code that runs inside a sandbox before the submission starts; it imports nothing else of the grader.

Every grading pays for its start-up time, hence few and small modules: no pathlib, json, contextlib or typing.
"""
