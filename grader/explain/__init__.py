"""`course explain`: the smallest change of a submission that would pass more, found by running it."""

BUDGET = 60.0  # [s] of processor time
