"""The interface of the world for systems and sensors; Gazebo's plugins use an `EntityComponentManager` for it.

`World` implements the protocol: time, description, MuJoCo's model and state, ground truth, editor, transport and
reports. It does not include stepping, rewinding and closing.
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
    """A world as seen by plugins; `gz.sim.world.World` documents each member."""

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
