"""Mistakes with Python itself: names, conditions, lists, results, code that never runs."""
