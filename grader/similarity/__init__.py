"""Similar submissions of a class: a hint for a person, never a matter of points. Nothing of a submission is run."""
