"""TrackController and TrackedVehicle: belts that carry, and vehicles that stand on them."""

from __future__ import annotations

import math
from typing import Any

import pytest

from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.msgs.vector3d_pb2 import Vector3d
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.systems.floating_world import body
from gz_course.tests.sim.gz.sim.systems.motion_world import plugin, world

GROUND = "<include><uri>model://ground_plane</uri></include>"
TRACKS = "<left_track><link>left</link></left_track><right_track><link>right</link></right_track>"
PARAMETERS = f"<body_link>base</body_link>{TRACKS}<tracks_separation>0.4</tracks_separation>"


def tank(inside: str = PARAMETERS, *, controllers: bool = True) -> World:
    def part(name: str, y: float, mass: float, shape: str = "") -> str:
        moments = "".join(f"<{axis}>{mass / 40}</{axis}>" for axis in ("ixx", "iyy", "izz"))
        return f"""<link name='{name}'><pose>0 {y} 0 0 0 0</pose><inertial><mass>{mass}</mass><inertia>{moments}
          </inertia></inertial>{shape}</link>"""

    box = "<collision name='c'><geometry><box><size>0.5 0.1 0.18</size></box></geometry></collision>"
    sides = "".join(
        part(name, y, 6.0, box)
        + f"<joint name='{name}_j' type='fixed'><parent>base</parent><child>{name}</child></joint>"
        + (plugin("TrackController", f"<link>{name}</link>") if controllers else "")
        for name, y in (("left", 0.2), ("right", -0.2))
    )
    text = f"<model name='tank'><pose>0 0 0.09 0 0 0</pose>{part('base', 0.0, 13.0)}{sides}"
    return world(f"{GROUND}{text}{plugin('TrackedVehicle', inside)}</model>", step=0.004)


def vehicle(made: World) -> Any:
    return next(each for each in made.systems if each.name == "TrackedVehicle")


def conveyor(inside: str = "", static: str = "<static>true</static>") -> World:
    belt = body(
        "<box><size>5 1 0.2</size></box>",
        name="belt",
        before=static,
        pose="0 0 0.1 0 0 0",
        plugins=plugin("TrackController", f"<link>l</link>{inside}"),
    )
    parcel = body("<box><size>0.2 0.2 0.2</size></box>", mass=1.0, name="parcel", pose="0 0 0.3 0 0 0")
    return world(belt + parcel, step=0.004)


@pytest.mark.parametrize("speed", [0.5, -0.5])
def test_a_vehicle_goes_straight_with_the_commanded_speed(speed: float) -> None:
    made = tank()
    assert not made.warnings
    vehicle(made).command(speed, 0.0)
    made.step(250)
    assert made.truth.velocity("tank").linear == pytest.approx((speed, 0, 0), abs=1e-3)
    assert made.truth.pose("tank").position == pytest.approx((speed, 0, 0.09), abs=0.08)


def test_a_vehicle_turns_to_the_commanded_side_and_tells_its_odometry(node: Node) -> None:
    limits = "<angular_velocity><max_acceleration>1</max_acceleration></angular_velocity>"
    made = tank(PARAMETERS + limits)
    made.attach(node)
    heard: list[Any] = []
    node.subscribe(Odometry, "/model/tank/odometry", heard.append)
    command = node.advertise("/model/tank/cmd_vel", Twist)
    twist = Twist()
    twist.angular.z = 0.5
    command.publish(twist)
    made.step(375)
    turning = made.truth.velocity("tank").angular[2]
    assert 0.4 < turning < 0.8, "with Gazebo's steering efficiency of one half"
    assert made.truth.pose("tank").position[:2] == pytest.approx((0, 0), abs=0.01)
    assert heard[-1].twist.angular.z == pytest.approx(0.5) and heard[-1].pose.orientation.z > 0.2
    node.advertise("/model/tank/steering_efficiency", Double).publish(Double(data=1.0))
    made.step(250)
    assert made.truth.velocity("tank").angular[2] < 0.75 * turning
    twist.linear.x = math.nan
    command.publish(twist)
    assert made.dropped_commands == {"/model/tank/cmd_vel": 1}
    made.reset()
    made.step(10)
    assert abs(made.data.qvel).max() < 0.01


def test_tracks_without_a_controller_here_are_told_by_topics(node: Node) -> None:
    made = tank(controllers=False)
    made.attach(node)
    speeds: list[float] = []
    centres: list[tuple[float, float]] = []
    node.subscribe(Double, "/model/tank/link/left/track_cmd_vel", lambda message: speeds.append(message.data))
    node.subscribe(
        Vector3d,
        "/model/tank/link/right/track_cmd_center_of_rotation",
        lambda message: centres.append((message.x, message.y)),
    )
    vehicle(made).command(0.4, 0.5)
    made.step(3)
    assert speeds == pytest.approx([-(0.4 - 0.5 * 0.4)]), "Gazebo's tracks pull backward"
    assert centres[0] == pytest.approx((0.0, 0.8), abs=1e-6)


def test_a_conveyor_carries_until_the_command_is_old(node: Node) -> None:
    made = conveyor("<max_command_age>0.8</max_command_age><min_acceleration>-2</min_acceleration>")
    made.attach(node)
    command = node.advertise("/model/belt/link/l/track_cmd_vel", Double)
    made.step(50)  # the parcel comes to rest
    command.publish(Double(data=-0.5))
    made.step(25)
    assert made.truth.velocity("parcel").linear[0] == pytest.approx(2 * 0.1, abs=0.04)
    made.step(125)
    assert made.truth.velocity("parcel").linear == pytest.approx((0.5, 0, 0), abs=2e-3)
    made.step(150)
    assert made.truth.velocity("parcel").linear == pytest.approx((0, 0, 0), abs=2e-3)
    command.publish(Double(data=math.inf))
    assert made.dropped_commands == {"/model/belt/link/l/track_cmd_vel": 1}


def test_a_belt_pulls_across_and_along_circles(node: Node) -> None:
    made = conveyor("<track_orientation>0 0 1.5707963267948966</track_orientation>")
    controller: Any = next(each for each in made.systems if each.name == "TrackController")
    controller.command(-0.2, None)
    made.step(100)
    assert made.truth.velocity("parcel").linear == pytest.approx((0, 0.2, 0), abs=2e-3)
    made = conveyor()
    made.attach(node)
    made.step(50)
    node.advertise("/model/belt/link/l/track_cmd_vel", Double).publish(Double(data=-0.2))
    centre = Vector3d(x=-1.0, y=-1.0, z=0.2)
    node.advertise("/model/belt/link/l/track_cmd_center_of_rotation", Vector3d).publish(centre)
    made.step(50)
    side = 0.2 / math.sqrt(2)
    assert made.truth.velocity("parcel").linear[:2] == pytest.approx((side, -side), abs=0.03)


def test_links_are_needed() -> None:
    with pytest.raises(SdfError, match="TrackController needs a <link>"):
        world(body(plugins=plugin("TrackController")))
    with pytest.raises(SdfError, match="TrackedVehicle needs at least one <right_track>"):
        tank(PARAMETERS.replace("right_track", "rigt_track"))
    with pytest.raises(SdfError, match="<left_track> needs a <link>"):
        tank(PARAMETERS.replace("<link>left</link>", ""))
    with pytest.raises(SdfError, match="<steering_efficiency> must be greater than zero, got 0"):
        tank(PARAMETERS + "<steering_efficiency>0</steering_efficiency>")
