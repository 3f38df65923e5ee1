"""What runs inside a box, between its walls going up and the submission's start; imports nothing else of the grader."""
