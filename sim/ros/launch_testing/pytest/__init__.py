"""Launch tests within a run of pytest."""
