"""The simulated world: SDF read as Gazebo reads it, stepped by MuJoCo, run by systems.

Start at `gz.sim.world` (the library), `gz.sim.server` (a world on the wire) or `gz.sim.commands.sim` (`gz sim`).
Nothing is imported here, so that asking for one part does not load MuJoCo for another.
"""
