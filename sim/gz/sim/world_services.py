"""The services of a server itself, with Gazebo's names and types.

`/world/W/control`, `/world/W/control/state`, `/world/W/playback/control`, `/world/W/gui/info`,
`/world/W/generate_world_sdf`, `/world/W/list_parameters|get_parameter|set_parameter` (a registry without parameters),
`/gazebo/worlds`, `/gazebo/resource_paths/get|add|resolve`, `/gazebo/starting_world` and
`/server_control`; the topic `/gazebo/resource_paths` tells of added paths. Callbacks run in the transport's threads;
access to the world goes through `World.requests`.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/ServerPrivate.cc
Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/SimulationRunner.cc
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.gui_pb2 import GUI
from gz_course.sim.gz.msgs.log_playback_control_pb2 import LogPlaybackControl
from gz_course.sim.gz.msgs.parameter_declarations_pb2 import ParameterDeclarations
from gz_course.sim.gz.msgs.parameter_error_pb2 import ParameterError
from gz_course.sim.gz.msgs.parameter_name_pb2 import ParameterName
from gz_course.sim.gz.msgs.parameter_pb2 import Parameter
from gz_course.sim.gz.msgs.parameter_value_pb2 import ParameterValue
from gz_course.sim.gz.msgs.sdf_generator_config_pb2 import SdfGeneratorConfig
from gz_course.sim.gz.msgs.server_control_pb2 import ServerControl
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.msgs.stringmsg_v_pb2 import StringMsg_V
from gz_course.sim.gz.msgs.world_control_pb2 import WorldControl
from gz_course.sim.gz.msgs.world_control_state_pb2 import WorldControlState
from gz_course.sim.gz.sim.errors import LOG, ResourceError, SimError
from gz_course.sim.gz.sim.requests import logged
from gz_course.sim.gz.sim.sdf.resources import find_resource, resource_paths
from gz_course.sim.gz.sim.sdf.writer import to_xml
from gz_course.sim.gz.sim.sdf_generator import generate_world

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.control import Control
    from gz_course.sim.gz.sim.world import World
    from gz_course.sim.gz.transport import Node

CONTROL_PATIENCE_S = 0.5
"""Time [s] after which a control request is answered before it is applied, if the world is not stepped."""


class WorldServices:
    """Offers the services of one server on its node; they end with the node."""

    def __init__(self, world: World, node: Node, control: Control, stop: Callable[[], None]) -> None:
        """Offer the services; `stop()` is called, from any thread, when a client asks the server to end."""
        self._world = world
        self._control = control
        self._stop = stop
        name, stem = world.name, world.topic
        offers: list[tuple[str, type, type, Callable[[Any], Any]]] = [
            (f"{stem}/control", WorldControl, Boolean, self._on_control),
            (f"{stem}/control/state", WorldControlState, Boolean, self._on_control_state),
            (f"{stem}/playback/control", LogPlaybackControl, Boolean, self._on_playback),
            (f"{stem}/gui/info", Empty, GUI, self._on_gui),
            (f"{stem}/list_parameters", Empty, ParameterDeclarations, lambda _: ParameterDeclarations()),
            (f"{stem}/get_parameter", ParameterName, ParameterValue, lambda _: (False, ParameterValue())),
            (
                f"{stem}/set_parameter",
                Parameter,
                ParameterError,
                lambda _: ParameterError(data=ParameterError.NOT_DECLARED),
            ),
            (f"{stem}/generate_world_sdf", SdfGeneratorConfig, StringMsg, self._on_generate),
            ("/gazebo/worlds", Empty, StringMsg_V, self._on_worlds),
            ("/gazebo/starting_world", Empty, StringMsg, lambda _: StringMsg(data=name)),
            ("/gazebo/resource_paths/get", Empty, StringMsg_V, self._on_resource_paths),
            ("/gazebo/resource_paths/add", StringMsg_V, Empty, self._on_add_resource_paths),
            ("/gazebo/resource_paths/resolve", StringMsg, StringMsg, self._on_resolve),
            ("/server_control", ServerControl, Boolean, self._on_server_control),
        ]
        for service, request, response, callback in offers:
            node.advertise_service(service, request, response, callback)
        self._paths = node.advertise("/gazebo/resource_paths", StringMsg_V)

    def _on_control(self, request: Any) -> Any:
        topic = f"{self._world.topic}/control"
        work = logged(lambda: self._control.apply(request), topic)
        asked = self._world.requests.put(work)
        if not asked.done.wait(CONTROL_PATIENCE_S):
            return Boolean(data=True)  # as in Gazebo: accepted, and applied when the world is stepped
        return Boolean(data=bool(asked.result))

    def _on_control_state(self, request: Any) -> Any:
        if request.HasField("state") and request.state.entities:
            LOG.error(
                "/world/%s/control/state: the state of components cannot be set here, the request is refused; "
                "use set_pose_vector and control",
                self._world.name,
            )
            return Boolean(data=False)
        return self._on_control(request.world_control)

    def _on_playback(self, request: Any) -> Any:
        asked = [field.name for field, _ in request.ListFields() if field.name not in ("header", "pause")]
        plays = any(each.name == "LogPlayback" for each in self._world.systems)
        if asked and not plays:
            LOG.error(
                "/world/%s/playback/control: %s is for the playback of a recording, and this world is simulated; "
                "its control service can reset it",
                self._world.name,
                asked[0],
            )
            return Boolean(data=False)
        end_ns = self._control.end_ns
        if request.HasField("seek") or (request.forward and end_ns is not None):
            time_ns = end_ns if request.forward and end_ns is not None else request.seek.sec * 10**9 + request.seek.nsec
            self._world.requests.call(lambda: self._control.seek(min(max(time_ns, 0), end_ns or time_ns)))
        control = WorldControl(pause=request.pause, multi_step=max(0, request.multi_step))
        if request.rewind:
            control.reset.all = True
        return self._on_control(control)

    def _on_gui(self, _: Any) -> Any:
        message: Any = GUI()
        element = self._world.description.element.find("gui")
        if element is not None:
            message.fullscreen = element.attributes.get("fullscreen", "") in ("1", "true")
            for plugin in element.all("plugin"):
                message.plugin.add(
                    name=plugin.attributes.get("name", ""),
                    filename=plugin.attributes.get("filename", ""),
                    innerxml="\n".join(to_xml(child) for child in plugin.children),
                )
        return message

    def _on_generate(self, request: Any) -> tuple[bool, Any]:
        expand = request.global_entity_gen_config.expand_include_tags.data
        try:
            text = self._world.requests.call(lambda: generate_world(self._world, expand_includes=expand))
        except SimError as error:
            LOG.error("/world/%s/generate_world_sdf: %s", self._world.name, error)
            return False, StringMsg()
        return True, StringMsg(data=text)

    def _on_worlds(self, _: Any) -> Any:
        return StringMsg_V(data=[self._world.name])

    def _on_resource_paths(self, _: Any) -> Any:
        return StringMsg_V(data=[str(path) for path in resource_paths()])

    def _on_add_resource_paths(self, request: Any) -> Any:
        known = [part for part in os.environ.get("GZ_SIM_RESOURCE_PATH", "").split(os.pathsep) if part]
        known += [path for path in request.data if path and os.pathsep not in path and path not in known]
        os.environ["GZ_SIM_RESOURCE_PATH"] = os.pathsep.join(known)
        self._paths.publish(self._on_resource_paths(None))
        return Empty()

    def _on_resolve(self, request: Any) -> tuple[bool, Any]:
        try:
            return True, StringMsg(data=str(find_resource(request.data).resolve()))
        except SimError as error:
            kind = "" if isinstance(error, ResourceError) else "it cannot be read: "
            LOG.error("/gazebo/resource_paths/resolve: %s%s", kind, error)
            return False, StringMsg()

    def _on_server_control(self, request: Any) -> Any:
        if request.stop:
            LOG.info("a client stops the server")
            self._stop()
        others = [
            field.name for field, _ in request.ListFields() if field.name not in ("header", "stop")
        ]  # saving, opening and cloning belong to Gazebo Classic; Gazebo ignores them
        if others:
            LOG.error("/server_control: %s is not supported, only stop is", others[0])
        return Boolean(data=request.stop and not others)
