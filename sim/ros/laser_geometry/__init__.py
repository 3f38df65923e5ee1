"""Turns laser scans into point clouds, in place of the `laser_geometry` package of ROS 2 (its Python half)."""

from gz_course.sim.ros.laser_geometry.laser_geometry import LaserProjection

__all__ = ["LaserProjection"]
