"""Mistakes with angles, rotations, limits and the rays of a scan."""
