"""What people and programs get to read: made from a score, never from a run."""
