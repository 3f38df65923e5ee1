"""Suspects in what a robot is steered by, and in drives."""
