"""Reports for people and programs, made from a score and its recordings."""
