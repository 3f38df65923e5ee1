"""What cameras and lidars are built on: rays, lenses, shading, point clouds."""
