"""UserCommands: creates, removes, moves and changes entities of a running world; a plugin of the world.

Services `/world/W/create`, `create_multiple`, `remove`, `set_pose`, `set_pose_vector`, `light_config`, `visual_config`,
`set_physics`, `set_spherical_coordinates`, `enable_collision`, `disable_collision` and `wheel_slip`. As in Gazebo each
answers true at once and puts the command into the queue, whatever it holds; its variant `/blocking` answers when it is
done, false if it failed. Failures are logged in one sentence. The commands are in `entity_commands` and
`property_commands`; the world is changed between two steps.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/user_commands/UserCommands.cc
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from gz_course.sim.gz.sim.errors import LOG, SimError
from gz_course.sim.gz.sim.plugins.system import System, system
from gz_course.sim.gz.sim.requests import logged
from gz_course.sim.gz.sim.sdf.description import Model, Plugin

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.editing.entity_commands import Command
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node


@system("UserCommands", "gz-sim-user-commands-system")
class UserCommands(System):
    """Offers the services; it has no parameters."""

    once = True

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Raise SdfError for a plugin in a model, because this one belongs to the world."""
        if model is not None:
            raise plugin.element.error("UserCommands belongs directly in the <world>, not inside a <model>")
        self._world = world

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
        from gz_course.sim.gz.msgs.material_color_pb2 import MaterialColor
        from gz_course.sim.gz.sim.editing import entity_commands, property_commands

        self._answer = Boolean
        prefix = self._world.topic
        for name, (request, command) in {**entity_commands.commands(), **property_commands.commands()}.items():
            for service, blocking in ((f"{prefix}/{name}", False), (f"{prefix}/{name}/blocking", True)):
                node.advertise_service(service, request, Boolean, self._server_of(service, command, blocking))
        topic = f"{prefix}/material_color"
        colour = self._server_of(topic, property_commands.material_color, False)
        node.subscribe(MaterialColor, topic, colour)

    def _server_of(self, service: str, command: Command, blocking: bool) -> Callable[[Any], Any]:
        world = self._world

        def serve(message: Any) -> Any:
            if not blocking:
                world.requests.put(logged(lambda: command(world, message)(), service))
                return self._answer(data=True)
            try:
                world.requests.call(command(world, message))
            except SimError as error:
                LOG.error("%s: %s", service, error)
                return self._answer(data=False)
            return self._answer(data=True)

        return serve
