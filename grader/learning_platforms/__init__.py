"""Grades for learning platforms: roster and gradebook become a file that Moodle or Canvas imports."""
