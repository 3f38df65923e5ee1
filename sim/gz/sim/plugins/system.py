"""The base class of all systems, and the lookup of the class of an SDF `<plugin>`.

A system is a file in `gz/sim/systems` with a class under the `@system` decorator; nothing else has to be edited.
`RunningSystems` calls `find_system` for every plugin and then the hooks of the class: `servos` before the physics model
is built, `configure` once, `bind` after each build, `start` at time zero and after a reset, `connect` when a transport
node is attached, `pre_update` and `post_update` around every physics step and `in_step` within, and `paused_update`
while a server is paused. While all systems rest (`rests_until`), only the functions of `sampler` are called.

Source: https://gazebosim.org/api/sim/8/createsystemplugins.html
"""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, TypeVar

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.physics.servos import JointServo
from gz_course.sim.gz.sim.physics.welds import WeldRequest
from gz_course.sim.gz.sim.sdf.description import Model, Plugin

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node


FOREVER_NS = 1 << 62
"""A simulated time [ns] that no run reaches."""


class UpdateInfo:
    """The time of a step: `sim_time_ns` [ns] at its end, `dt` [s] and `iterations` (including this one)."""

    __slots__ = ("dt", "iterations", "sim_time_ns")

    def __init__(self, dt: float) -> None:
        self.dt = dt
        self.sim_time_ns = 0
        self.iterations = 0


class System:
    """Base of all systems. Hooks that are not overridden cost nothing per step."""

    name: ClassVar[str] = ""
    filename: ClassVar[str] = ""
    parameters: ClassVar[frozenset[str]] = frozenset()
    once: ClassVar[bool] = False
    """True if a world may have only one instance."""
    joins_topics: ClassVar[bool] = False
    """True if it may share topics of other systems without a warning."""
    pushes: ClassVar[bool] = False
    """True if `pre_update` adds forces to `data.xfrc_applied`, which then is zero at the beginning of every step."""

    @classmethod
    def servos(cls, model: Model, plugin: Plugin) -> list[JointServo]:
        """Return the joints of `model` that this system drives. Raises SdfError for a joint that does not exist."""
        return []

    @classmethod
    def welds(cls, model: Model, plugin: Plugin) -> list[WeldRequest]:
        """Return the links that this system may connect. Raises SdfError for a link of `model` that does not exist."""
        return []

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Read the parameters; `model` is None for a plugin of the world."""

    def bind(self) -> None:
        """Look up ids and addresses in MuJoCo's model, which was just built or rebuilt."""

    def start(self) -> None:
        """Initialize the state at time zero; called after the first `bind` and after every reset."""

    def connect(self, node: Node) -> None:
        """Advertise and subscribe on `node`, which belongs to this system alone; the world closes it."""

    def close(self) -> None:
        """Close everything but the node; called when the model is removed or the world closes."""

    def pre_update(self, info: UpdateInfo) -> None:
        """Act before the physics step, for example set controls."""

    def in_step(self, info: UpdateInfo) -> None:
        """Change the constraints of the physics step: MuJoCo has found contacts, but not their forces."""

    def post_update(self, info: UpdateInfo) -> None:
        """Read the result of the physics step, for example publish it."""

    def sampler(self) -> Callable[[], None]:
        """Return a function that records the state after every physics step, also at rest, before `post_update`; called
        after each `bind`.
        """
        raise NotImplementedError

    def rests_until(self, info: UpdateInfo) -> int:
        """Return the simulated time [ns] of the next step in which `pre_update` or `post_update` has something to do.

        Asked after a step; the hooks are not called in the steps before that time. 0 means the next step.
        """
        return 0

    def paused_update(self, info: UpdateInfo) -> None:
        """Publish what is due while a running server is paused; called ten times per second of wall time and after
        every change.
        """


S = TypeVar("S", bound=type[System])
_SYSTEMS: dict[str, type[System]] = {}


def system(name: str, filename: str) -> Callable[[S], S]:
    """Register a class under Gazebo's system name (`DiffDrive`) and file name (`gz-sim-diff-drive-system`)."""

    def register(cls: S) -> S:
        cls.name, cls.filename = name, filename
        _SYSTEMS[name] = cls
        return cls

    return register


def systems() -> dict[str, type[System]]:
    """Return every system by name, including those declared beside their sensor type."""
    scan("systems")
    scan("sensors")
    return dict(_SYSTEMS)


@cache
def scan(room: str) -> None:
    """Import every file of a folder of this package, and of those in it, so that their classes register themselves."""
    for module in pkgutil.iter_modules([str(Path(__file__).parents[1].joinpath(*room.split(".")))]):
        importlib.import_module(f"gz_course.sim.gz.sim.{room}.{module.name}")
        if module.ispkg:
            scan(f"{room}.{module.name}")


BUILT_IN = {"Physics"}
"""Systems that are part of `World`."""

GAZEBO_SYSTEMS = frozenset(
    [
        "AckermannSteering",
        "AcousticComms",
        "AdvancedLiftDrag",
        "AirPressure",
        "AirSpeed",
        "Altimeter",
        "ApplyJointForce",
        "ApplyLinkWrench",
        "Breadcrumbs",
        "Buoyancy",
        "BuoyancyEngine",
        "CameraVideoRecorder",
        "ColladaWorldExporter",
        "CommsEndpoint",
        "Contact",
        "CpuLidar",
        "DetachableJoint",
        "DiffDrive",
        "DopplerVelocityLogSystem",
        "DriveToPoseController",
        "DynamicDetachableJoint",
        "Elevator",
        "EntitySemantics",
        "EnvironmentPreload",
        "EnvironmentalSensorSystem",
        "EnvironmentalSystem",
        "FollowActor",
        "ForceTorque",
        "FreeSpaceExplorer",
        "Hydrodynamics",
        "Imu",
        "JointController",
        "JointPositionController",
        "JointStatePublisher",
        "JointTrajectoryController",
        "KineticEnergyMonitor",
        "Label",
        "LensFlare",
        "LiftDrag",
        "LighterThanAirDynamics",
        "LinearBatteryPlugin",
        "LogPlayback",
        "LogRecord",
        "LogVideoRecorder",
        "LogicalAudioSensorPlugin",
        "LogicalCamera",
        "LookupWheelSlip",
        "Magnetometer",
        "MecanumDrive",
        "ModelPhotoShoot",
        "MulticopterMotorModel",
        "MulticopterVelocityControl",
        "NavSat",
        "OdometryPublisher",
        "OpticalTactilePlugin",
        "ParticleEmitter",
        "PerfectComms",
        "PerformerDetector",
        "PosePublisher",
        "PythonSystemLoader",
        "RFComms",
        "SceneBroadcaster",
        "Sensors",
        "ShaderParam",
        "SpacecraftThrusterModel",
        "Thermal",
        "ThermalSensor",
        "Thruster",
        "TouchPlugin",
        "TrackController",
        "TrackedVehicle",
        "TrajectoryFollower",
        "TriggeredPublisher",
        "UserCommands",
        "VelocityControl",
        "WheelSlip",
        "WindEffects",
    ]
)
"""Names of the systems of Gazebo 8 and later, whether they run here or not; EnvironmentalSystem is another name of
EnvironmentalSensorSystem.

Source: https://github.com/gazebosim/gz-sim/tree/gz-sim8/src/systems and its branch `main`; the alias is in
`environmental_sensor_system/EnvironmentalSensorSystem.cc`
"""


def other_gazebo_systems() -> frozenset[str]:
    """Return the systems of Gazebo that do not run here."""
    return GAZEBO_SYSTEMS - BUILT_IN - systems().keys()


_OWN_NAMESPACES = ("gz::sim::", "ignition::gazebo::")
_OWN_FILES = ("gz-sim", "ignition-gazebo")
_CLASSIC = {
    "libgazebo_ros_diff_drive": "gz-sim-diff-drive-system",
    "libgazebo_ros_ray_sensor": "gz-sim-sensors-system in the world",
    "libgazebo_ros_laser": "gz-sim-sensors-system in the world",
    "libgazebo_ros_camera": "gz-sim-sensors-system in the world",
    "libgazebo_ros_imu_sensor": "gz-sim-imu-system in the world",
    "libgazebo_ros_joint_state_publisher": "gz-sim-joint-state-publisher-system",
    "libgazebo_ros_p3d": "gz-sim-odometry-publisher-system",
}


def system_name(plugin: Plugin) -> str:
    """Return the Gazebo name of the system of a plugin, for any spelling of its attributes."""
    if plugin.name:
        last = plugin.name.rsplit("::", 1)[-1]
        if last in BUILT_IN | GAZEBO_SYSTEMS or last in systems():
            return last
    filename = plugin.filename.rsplit("/", 1)[-1].removeprefix("lib").removesuffix(".so")
    for prefix in ("ignition-gazebo", "gz-sim"):
        if filename.startswith(prefix) and filename.endswith("-system"):
            middle = filename[len(prefix) : -len("-system")].lstrip("0123456789").strip("-")
            word = middle.replace("-", "").lower()
            for name in (*systems(), *BUILT_IN, *sorted(GAZEBO_SYSTEMS)):
                if name.lower() == word:
                    return name
    return plugin.name.rsplit("::", 1)[-1] or filename


def find_system(plugin: Plugin, diagnostics: Diagnostics) -> type[System] | None:
    """Return the class of a plugin, or None after a warning."""
    name = system_name(plugin)
    found = systems().get(name)
    if found is not None:
        _check_parameters(plugin, found, diagnostics)
        return found
    where = plugin.element.where
    classic = plugin.filename.rsplit("/", 1)[-1].removesuffix(".so")
    if name in BUILT_IN:
        return None
    if classic.startswith("libgazebo_"):
        instead = _CLASSIC.get(classic, "the gz-sim system of the same purpose")
        diagnostics.warn(where, f"plugin '{plugin.filename}' is of Gazebo Classic and is ignored; use {instead}")
    elif name in other_gazebo_systems():
        diagnostics.warn(where, f"system '{name}' exists in Gazebo but not in this simulator, it is ignored")
    elif _is_foreign(plugin):
        text = f"plugin '{plugin.name or plugin.filename}' is not one of Gazebo's own; "
        diagnostics.warn(where, f"{text}compiled plugins cannot run here, it is ignored")
    else:
        hint = did_you_mean(name, {*systems(), *BUILT_IN}, listing="systems that run here are")
        diagnostics.warn(where, f"no system is called '{plugin.name or plugin.filename}', it is ignored{hint}")
    return None


def _is_foreign(plugin: Plugin) -> bool:
    """Tell whether a plugin is somebody's own library rather than a misspelt system of Gazebo."""
    file = plugin.filename.rsplit("/", 1)[-1]
    if "::" in plugin.name:
        return not plugin.name.startswith(_OWN_NAMESPACES)
    return (file.startswith("lib") or file.endswith(".so")) and not file.removeprefix("lib").startswith(_OWN_FILES)


def _check_parameters(plugin: Plugin, found: type[System], diagnostics: Diagnostics) -> None:
    for child in plugin.element.children:
        if found.parameters and child.tag not in found.parameters and ":" not in child.tag:
            hint = did_you_mean(child.tag, found.parameters, listing="its parameters are")
            diagnostics.warn(child.where, f"{found.name} has no parameter <{child.tag}>, it is ignored{hint}")
