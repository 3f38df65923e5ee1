"""The recording of a run: written once during the run, read by scoring and reports."""
