"""Suspects in what is kept too long, lost, or never noticed."""
