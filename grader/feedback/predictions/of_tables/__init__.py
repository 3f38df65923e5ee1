"""What a student who filled in a column of a table with one misconception wrote into it."""
