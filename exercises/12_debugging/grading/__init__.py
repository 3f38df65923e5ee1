"""What grades the exercise 12_debugging: its checks, and what they say about mistakes."""
