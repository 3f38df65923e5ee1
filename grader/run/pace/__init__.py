"""How simulated time goes on: in lock-step with the submission's processes, or with the wall clock."""
