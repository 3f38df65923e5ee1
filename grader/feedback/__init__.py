"""What a report says about a student's work beside the score: mistakes in its text, misconceptions that fit its run.

`facts/` reads a file; `slips/` are mistakes that are certain by the text, `suspects/` those that are named only with a
symptom, `launch_files/` those of launch files. `recorded/` makes sentences of what these found, `predictions/` are what
a program with one misconception would have said or done, `errors/` is what errors mean.
"""
