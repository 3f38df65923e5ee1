"""Actions of launch files: a server, and a model that is created in it."""

from gz_course.sim.bridge.ros_gz_sim.actions.gz_spawn_model import GzSpawnModel
from gz_course.sim.bridge.ros_gz_sim.actions.gzserver import GzServer

__all__ = ["GzServer", "GzSpawnModel"]
