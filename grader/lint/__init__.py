"""Linters of a student's Python file; the diagnosis uses what they find if a check failed."""
