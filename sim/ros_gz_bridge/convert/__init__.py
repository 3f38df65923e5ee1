"""Conversions, one file for each ROS message package, named like the package; ``type_pairs`` finds them here."""
