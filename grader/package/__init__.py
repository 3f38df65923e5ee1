"""Packages an exercise for services that grade by themselves: `gradescope.py` and the programs it puts in."""
