"""The one timeline of every recording: simulated time. Wall time stays out, so that equal runs record equally."""

TIMELINE = "sim_time"
