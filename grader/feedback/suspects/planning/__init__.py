"""Suspects in maps, goals and ways through a map."""
