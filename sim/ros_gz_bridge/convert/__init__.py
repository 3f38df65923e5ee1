"""Conversions, one file for each ROS message package, named like it; ``type_pairs`` finds them here."""
