"""The submission's processes as the grader sees them: their output, their connections, what they report."""
