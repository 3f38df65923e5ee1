"""Converts the description of a world to a MuJoCo model and steps its joints, contacts and state."""
