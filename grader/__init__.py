"""The grader: takes in a submission, runs it in lock-step, records the run, scores the recording and reports."""
