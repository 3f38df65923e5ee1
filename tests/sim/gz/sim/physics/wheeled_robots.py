"""Four robots with two driven wheels, from 1 to 140 kg, for the proofs of driving."""

from __future__ import annotations

from dataclasses import dataclass

from gz_course.sim.gz.sim.systems.diff_drive import DiffDrive
from gz_course.sim.gz.sim.world import World


@dataclass(frozen=True)
class WheeledRobot:
    """Dimensions of a robot: masses [kg], lengths [m].

    The body is a box whose centre is above the wheels, shifted backwards by `back`; a ball without friction supports
    the rear.
    """

    name: str
    body: float
    wheel: float
    radius: float
    separation: float
    length: float
    height: float
    back: float

    @property
    def mass(self) -> float:
        return self.body + 2 * self.wheel

    def sdf(self, plugins: str = "", drive: str = "") -> str:
        """Return the robot as a <model> with `plugins`; `drive` is the content of its DiffDrive."""
        r, width = self.radius, 0.8 * self.separation
        tyre = 0.4 * r
        middle = r + self.height / 2
        m, a, b, c = self.body, self.length, width, self.height
        inertia = [m * (b * b + c * c) / 12, m * (a * a + c * c) / 12, m * (a * a + b * b) / 12]
        flat = self.wheel * r * r / 2
        side = self.wheel * (3 * r * r + tyre * tyre) / 12
        ball = 0.35 * r
        wheels = "".join(
            f"""<link name='{side_name}_wheel'><pose>0 {y} {r} -1.5707963267948966 0 0</pose>
            <inertial><mass>{self.wheel}</mass><inertia><ixx>{side}</ixx><iyy>{side}</iyy><izz>{flat}</izz></inertia>
            </inertial><collision name='tyre'><geometry><cylinder><radius>{r}</radius><length>{tyre}</length></cylinder>
            </geometry></collision></link><joint name='{side_name}_joint' type='revolute'><parent>base</parent>
            <child>{side_name}_wheel</child><axis><xyz>0 0 1</xyz></axis></joint>"""
            for side_name, y in (("left", self.separation / 2), ("right", -self.separation / 2))
        )
        return f"""<model name='robot'>
          <link name='base'><pose>0 0 {r} 0 0 0</pose>
            <inertial><pose>{-self.back} 0 {middle - r} 0 0 0</pose><mass>{m}</mass><inertia><ixx>{inertia[0]}</ixx>
              <iyy>{inertia[1]}</iyy><izz>{inertia[2]}</izz></inertia></inertial>
            <collision name='ball'><pose>{-0.45 * a} 0 {ball - r} 0 0 0</pose>
              <geometry><sphere><radius>{ball}</radius></sphere></geometry>
              <surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction></surface></collision>
            <collision name='nose'><pose>{0.45 * a} 0 {ball * 1.06 - r} 0 0 0</pose>
              <geometry><sphere><radius>{ball}</radius></sphere></geometry>
              <surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction></surface></collision>
          </link>{wheels}
          <plugin filename='gz-sim-diff-drive-system' name='gz::sim::systems::DiffDrive'>
            <left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>
            <wheel_separation>{self.separation}</wheel_separation><wheel_radius>{r}</wheel_radius>{drive}
          </plugin>{plugins}</model>"""

    def world(self, step: float = 0.001, plugins: str = "", drive: str = "") -> World:
        """Return a world with only the robot at rest on a ground plane."""
        return World.from_string(
            f"""<sdf version='1.10'><world name='w'><physics type='x'><max_step_size>{step}</max_step_size></physics>
            <plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>
            <include><uri>model://ground_plane</uri></include>{self.sdf(plugins, drive)}</world></sdf>"""
        )


ROBOTS = (
    WheeledRobot("1 kg", 0.9, 0.05, 0.033, 0.16, 0.2, 0.02, 0.01),
    WheeledRobot("4 kg", 3.2, 0.4, 0.05, 0.25, 0.3, 0.05, 0.02),
    WheeledRobot("40 kg", 34.0, 3.0, 0.1, 0.5, 0.6, 0.2, 0.05),
    WheeledRobot("140 kg", 120.0, 10.0, 0.2, 0.7, 1.0, 0.4, 0.1),
)


def drive_of(world: World) -> DiffDrive:
    """Return the DiffDrive of the robot."""
    return next(system for system in world.systems if isinstance(system, DiffDrive))
