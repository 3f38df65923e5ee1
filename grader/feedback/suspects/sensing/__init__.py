"""Suspects in what reads scans, pictures and gyroscopes, and in places of things that were seen."""
