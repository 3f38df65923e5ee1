"""The run of a submission against the simulator: its processes, its sandbox, and the lock-step between the two."""
