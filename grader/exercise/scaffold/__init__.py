"""A new exercise: `exercise.py` makes its two halves from the files in `template/`; called by `course new`."""
