"""Scoring of a recording, independent of how the recording was made."""
