"""Packages of an exercise for other services: `gradescope.py`, and the programs that go into its zip."""
