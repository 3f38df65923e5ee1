"""What a student's Python file says, read once: its tree, its numbers, its clocks, the lines that make what is sent."""
