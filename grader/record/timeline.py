"""The only timeline of a recording: simulated time. Without wall time, equal runs give equal recordings."""

TIMELINE = "sim_time"
