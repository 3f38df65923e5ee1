"""Run a submission against the simulator: its process, its sandbox, and the lock-step between the two."""
