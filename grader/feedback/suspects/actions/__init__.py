"""Suspects in action servers, their goals and patrols."""
