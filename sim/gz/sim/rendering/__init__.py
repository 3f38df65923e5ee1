"""Ray casting, camera models, shading and point clouds for cameras and lidars."""
