"""A class: find the submissions, grade each in a process of its own, keep a journal, write the gradebook."""
