"""The grader: intake, run in lock-step, record, score the recording, report."""
