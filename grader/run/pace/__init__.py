"""The pace of simulated time: in lock-step with the submission's processes, or with the wall clock."""
