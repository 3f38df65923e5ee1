"""Creation of a new exercise: `exercise.py` makes both halves from the files in `template/` for `course new`."""
