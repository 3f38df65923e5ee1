"""Explanations of wrong answers: what a program with a certain misconception would have said, from the recording.

The one that fits what the student's program said is named in the first sentence of the feedback. An explanation is one
function in a file of `of_answers/` (numbers that answer scans or samples), of `of_commands/` (velocity commands), or of
`of_tables/` (entries of a table). What is wrong with a robot (`of_robots/`) is asked by the checks that see it.
"""
