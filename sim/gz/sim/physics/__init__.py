"""Converts the description of a world to a MuJoCo model, and accesses its joints, contacts and state."""
