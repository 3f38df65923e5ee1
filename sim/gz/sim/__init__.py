"""The simulated world: SDF read as Gazebo reads it, stepped by MuJoCo, run by systems.

Start at `gz.sim.world` (the library), `gz.sim.server` (a world on gz-transport) or `gz.sim.commands.sim` (`gz sim`).
Nothing is imported here, so that parts without physics do not load MuJoCo.
"""
