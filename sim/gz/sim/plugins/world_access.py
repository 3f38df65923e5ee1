"""What systems and sensors may use of their world.

Gazebo hands its plugins an `EntityComponentManager` to the same end. Here it is a protocol that `World` fulfils: time,
the description, MuJoCo's model and state, the truth, the editor, and where messages and commands go. Stepping,
rewinding and closing a world are not in it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import mujoco

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.sdf.description import WorldDescription
from gz_course.sim.gz.sim.sdf.resources import Resources

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.editing.editor import Editor
    from gz_course.sim.gz.sim.entities import Entities
    from gz_course.sim.gz.sim.requests import Requests
    from gz_course.sim.gz.sim.running_systems import RunningSystems
    from gz_course.sim.gz.sim.truth import Truth


class WorldAccess(Protocol):
    """A world as a plugin sees it; `gz.sim.world.World` says what each part is."""

    description: WorldDescription
    diagnostics: Diagnostics
    resources: Resources
    seed: int
    render_engine: str
    iterations: int
    model: mujoco.MjModel
    data: mujoco.MjData
    truth: Truth
    editor: Editor
    systems: RunningSystems
    entities: Entities
    requests: Requests

    @property
    def name(self) -> str: ...

    @property
    def topic(self) -> str: ...

    @property
    def step_size_ns(self) -> int: ...

    @property
    def sim_time_ns(self) -> int: ...

    def drop_command(self, topic: str, what: str) -> None: ...
