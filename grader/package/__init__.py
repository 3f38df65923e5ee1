"""Packages of an exercise for other services: `gradescope.py`, `prairielearn.py`, and the programs in their zips."""
