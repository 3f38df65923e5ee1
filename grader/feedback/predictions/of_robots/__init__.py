"""Faults of a robot that its parts prove: how it drives, how it stands, what its lidar sees.

Each function returns the end of a sentence, or an empty text if the robot does not have that fault.
"""
