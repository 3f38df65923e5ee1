"""Grading of a class: find the submissions, grade each in its own process, keep a journal, write the gradebook."""
