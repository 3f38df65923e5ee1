"""The lidar against plane geometry: every ray of the built-in room, near and far limits, clipping, noise, rates."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.sensors.lidar import Lidar
from gz_course.sim.gz.sim.systems.sensors import Sensors
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

Load = Callable[..., World]
_numbers = itertools.count()


def lidar_of(world: World) -> Lidar:
    sensors = next(system for system in world.systems if isinstance(system, Sensors)).sensors
    (lidar,) = (sensor for sensor in sensors if isinstance(sensor, Lidar))
    return lidar


def circle(x: float, y: float, radius: float, angle: float) -> float:
    """Return the distance from the origin along `angle` to a circle, inf without a hit."""
    along = x * math.cos(angle) + y * math.sin(angle)
    across = x * math.sin(angle) - y * math.cos(angle)
    if abs(across) > radius or along < 0:
        return math.inf
    return along - math.sqrt(radius**2 - across**2)


def rectangle(x: float, y: float, width: float, depth: float, turn: float, angle: float) -> float:
    """Return the distance from the origin along `angle` to a rotated rectangle, by clipping against its two slabs."""
    c, s = math.cos(turn), math.sin(turn)
    start = (-(x * c + y * s), -(-x * s + y * c))
    ray = (math.cos(angle - turn), math.sin(angle - turn))
    near, far = 0.0, math.inf
    for position, direction, half in zip(start, ray, (width / 2, depth / 2), strict=True):
        if abs(direction) < 1e-15:
            if abs(position) > half:
                return math.inf
            continue
        first, second = sorted(((-half - position) / direction, (half - position) / direction))
        near, far = max(near, first), min(far, second)
    return near if near <= far else math.inf


def ellipse(x: float, y: float, a: float, b: float, turn: float, angle: float) -> float:
    c, s = math.cos(turn), math.sin(turn)
    px, py = -(x * c + y * s) / a, -(-x * s + y * c) / b
    dx, dy = math.cos(angle - turn) / a, math.sin(angle - turn) / b
    qa, qb, qc = dx * dx + dy * dy, px * dx + py * dy, px * px + py * py - 1
    root = qb * qb - qa * qc
    return (-qb - math.sqrt(root)) / qa if root >= 0 and qb < 0 else math.inf


def room_at(x: float, y: float, z: float, angle: float) -> float:
    """Return the distance to the built-in room from (x, y, z) along `angle`, independently of the SDF reader."""
    ball = math.sqrt(0.35**2 - (0.35 - z) ** 2)
    boulder = math.sqrt(1 - ((z - 0.3) / 0.4) ** 2)
    return min(
        rectangle(0 - x, -3.05 - y, 8.2, 0.1, 0, angle),
        rectangle(0 - x, 3.05 - y, 8.2, 0.1, 0, angle),
        rectangle(-4.05 - x, 0 - y, 0.1, 6, 0, angle),
        rectangle(4.05 - x, -1.9 - y, 0.1, 2.2, 0, angle),
        rectangle(0.2 - x, -1.9 - y, 0.6, 0.5, 0.5, angle),
        circle(-1.2 - x, 1.6 - y, 0.2, angle),
        circle(-3.2 - x, -1.6 - y, ball, angle),
        circle(2.6 - x, -1.4 - y, 0.15, angle),
        ellipse(0.9 - x, 2.4 - y, 0.5 * boulder, 0.3 * boulder, 0.3, angle),
    )


def test_every_beam_of_the_room_is_where_geometry_says() -> None:
    world = World.load("lidar_room.sdf")
    lidar = lidar_of(world)
    assert (lidar.topic, lidar.frame_id, lidar.horizontal.count) == ("/lidar/scan", "lidar_link", 360)
    assert lidar.horizontal.step == pytest.approx(2 * math.pi / 359)
    measured = lidar.ranges()
    antenna = [i for i, angle in enumerate(lidar.horizontal.angles) if circle(-0.0752, 0.0274, 0.002, angle) < 1]
    assert 2 <= len(antenna) <= 4
    for index, angle in enumerate(lidar.horizontal.angles):
        expected = room_at(-2.0, 0.0, 0.18, angle)
        if index in antenna:
            assert measured[index] == -math.inf
        elif expected > 6.0:
            assert measured[index] == math.inf, angle
        else:
            assert measured[index] == pytest.approx(expected, abs=1e-6), angle
    assert np.isposinf(measured).sum() > 20


def test_the_scan_follows_the_robot() -> None:
    world = World.load("lidar_room.sdf")
    next(system for system in world.systems if system.name == "DiffDrive").command(0.5, 0.3)  # type: ignore[attr-defined]
    world.step(3000)
    lidar = lidar_of(world)
    measured = lidar.ranges()
    pose = world.truth.link_pose("robot", "lidar_link")
    expected = np.array([room_at(*pose.position, pose.yaw() + angle) for angle in lidar.horizontal.angles])
    both = np.isfinite(measured) & (expected < 6.0)
    assert both.sum() > 250
    # A pose one step old would be wrong by 0.5 mm ahead and behind.
    assert np.median(np.abs(measured[both] - expected[both])) < 5e-5


RIG = """<model name='rig'><static>1</static><pose>0 0 1 0 0 0</pose><link name='l'>{parts}
  <sensor name='s' type='{kind}'><update_rate>{rate}</update_rate><lidar><scan><horizontal>
      <samples>{samples}</samples>
  <min_angle>-1.5707963267948966</min_angle><max_angle>1.5707963267948966</max_angle>
      </horizontal>{vertical}</scan>
  <range><min>{near}</min><max>10</max></range>{noise}</lidar></sensor></link></model>"""


def rig(**changes: Any) -> str:
    usual = {
        "parts": "",
        "kind": "gpu_lidar",
        "rate": 10,
        "samples": 3,
        "vertical": "",
        "near": 0.3,
        "noise": "",
    }
    return RIG.format(**{**usual, **changes})


def part(kind: str, pose: str, geometry: str) -> str:
    return f"<{kind} name='{next(_numbers)}'><pose>{pose}</pose><geometry>{geometry}</geometry></{kind}>"


def wall(kind: str, x: float) -> str:
    body = part(kind, "0 0 0 0 0 0", "<box><size>0.2 1 1</size></box>")
    return f"<model name='{kind}{x}'><static>1</static><pose>{x} 0 1 0 0 0</pose><link name='l'>{body}</link></model>"


def test_gpu_lidar_sees_visuals_and_lidar_sees_collisions(load_text: Load) -> None:
    walls = wall("visual", 3.1) + wall("collision", 2.1)
    assert lidar_of(load_text(rig() + walls)).ranges().tolist() == pytest.approx([math.inf, 3.0, math.inf])
    assert lidar_of(load_text(rig(kind="lidar") + walls)).ranges().tolist() == pytest.approx([math.inf, 2.0, math.inf])


def test_near_far_and_clipped(load_text: Load) -> None:
    # Straight ahead the clip cube ends at 0.3 / sqrt(3) = 0.173 m.
    assert lidar_of(load_text(rig() + wall("visual", 0.35))).ranges()[1] == -math.inf
    assert lidar_of(load_text(rig() + wall("visual", 10.2))).ranges()[1] == math.inf
    assert lidar_of(load_text(rig() + wall("visual", 10.05))).ranges()[1] == pytest.approx(9.95)
    hidden = part("visual", "0.12 0 0 0 0 0", "<box><size>0.05 0.05 0.05</size></box>")
    assert lidar_of(load_text(rig(parts=hidden) + wall("visual", 3.1))).ranges()[1] == pytest.approx(3.0)


SHAPES = {
    "box": "<box><size>1 1 1</size></box>",
    "sphere": "<sphere><radius>0.5</radius></sphere>",
    "cylinder": "<cylinder><radius>0.5</radius><length>1</length></cylinder>",
    "capsule": "<capsule><radius>0.5</radius><length>1</length></capsule>",
    "ellipsoid": "<ellipsoid><radii>0.5 0.5 0.5</radii></ellipsoid>",
}


@pytest.mark.parametrize("shape", sorted(SHAPES))
def test_a_housing_round_the_sensor_is_looked_through_but_the_same_shape_ahead_is_seen(
    load_text: Load, shape: str
) -> None:
    housing = part("visual", "0.1 0.05 0 0 0 0", SHAPES[shape])
    ahead = part("visual", "2 0 0 0 0 0", SHAPES[shape])
    world = load_text(rig(parts=housing + ahead))
    groups = world.model.geom_group.copy()
    assert lidar_of(world).ranges()[1] == pytest.approx(1.5)
    assert (world.model.geom_group == groups).all()


def test_rows_come_lowest_first(load_text: Load) -> None:
    vertical = "<vertical><samples>3</samples><min_angle>-0.5</min_angle><max_angle>0.5</max_angle></vertical>"
    floor = "<include><uri>model://ground_plane</uri></include>"
    ranges = lidar_of(load_text(rig(vertical=vertical, samples=5) + floor)).ranges()
    assert ranges.shape == (15,)
    assert ranges[:5] == pytest.approx([1 / math.sin(0.5)] * 5)
    assert np.isposinf(ranges[5:]).all()
    # The middle ray of every row hits the wall ahead, and no other ray does.
    ahead = lidar_of(load_text(rig(vertical=vertical, samples=5) + wall("visual", 0.9))).ranges()
    assert np.isfinite(ahead).tolist() == [False, False, True, False, False] * 3


@settings(max_examples=40, deadline=None)
@given(st.floats(-math.pi, math.pi), st.floats(0.5, 9.0), st.floats(0.05, 0.4))
def test_a_pillar_anywhere_is_measured(angle: float, distance: float, radius: float) -> None:
    x, y = (distance + radius) * math.cos(angle), (distance + radius) * math.sin(angle)
    pillar = part(
        "visual",
        f"{x!r} {y!r} 0 0 0 0",
        f"<cylinder><radius>{radius!r}</radius><length>1</length></cylinder>",
    )
    sensor = (
        rig(samples=181)
        .replace("-1.5707963267948966", "-3.141592653589793")
        .replace("1.5707963267948966", "3.141592653589793")
    )
    sdf = (
        "<sdf version='1.9'><world name='w'><plugin "
        f"name='gz::sim::systems::Sensors'/>{sensor}<model name='p'><static>1</static><pose>0 0 1 0 0 "
        f"0</pose><link name='l'>{pillar}</link></model></world></sdf>"
    )
    lidar = lidar_of(World.from_string(sdf))
    for beam, measured in zip(lidar.horizontal.angles, lidar.ranges(), strict=True):
        expected = circle(x, y, radius, beam)
        grazing = abs(abs(x * math.sin(beam) - y * math.cos(beam)) - radius) < 1e-6
        if not grazing:
            assert measured == (pytest.approx(expected, abs=1e-6) if expected <= 10 else math.inf)


NOISY = "<noise><type>gaussian</type><stddev>0.05</stddev></noise>"


def test_noise_is_seeded_per_scan_and_only_on_what_was_measured(load_text: Load, node: Node) -> None:
    world_text = rig(samples=91, noise=NOISY) + wall("visual", 3.1)

    def scans(seed: int, listen_from: int) -> list[list[float]]:
        from gz_course.sim.gz.transport import NodeOptions, Scope

        heard: list[list[float]] = []
        with Node(NodeOptions(scope=Scope.PROCESS)) as own:
            world = load_text(world_text, seed=seed, node=own)
            world.step(listen_from)
            own.subscribe(LaserScan, lidar_of(world).topic, lambda message: heard.append(list(message.ranges)))
            world.step(500 - listen_from)
        return heard

    whole = scans(3, 0)
    assert len(whole) == 6 and whole[0] != whole[1]
    assert scans(3, 0) == whole
    assert scans(3, 250) == whole[3:], "a late listener must hear the same scans"
    assert scans(4, 0) != whole
    exact = lidar_of(load_text(world_text)).ranges()
    difference = np.array(whole)[:, np.isfinite(exact)] - exact[np.isfinite(exact)]
    assert difference.std() == pytest.approx(0.05, rel=0.2) and abs(difference.mean()) < 0.02
    assert (np.isinf(np.array(whole)) == np.isinf(exact)).all()


def test_noise_stays_within_the_range_limits(load_text: Load) -> None:
    loud = NOISY.replace("0.05", "5")
    values = lidar_of(load_text(rig(samples=91, noise=loud) + wall("visual", 3.1))).measure()
    finite = values[np.isfinite(values)]
    assert finite.min() == 0.3 and finite.max() == 10.0


def test_rates_and_message(load_text: Load, node: Node) -> None:
    world = load_text(rig(rate=30, samples=3) + wall("visual", 3.1), node=node)
    heard: list[Any] = []
    assert lidar_of(world).topic == "/world/w/model/rig/link/l/sensor/s/scan"
    node.subscribe(LaserScan, lidar_of(world).topic, heard.append)
    world.step(200)
    assert [message.header.stamp.nsec // 1_000_000 for message in heard] == [1, 33, 66, 99, 132, 165, 198]
    message = heard[-1]
    assert (message.count, message.vertical_count, message.range_min, message.range_max) == (3, 1, 0.3, 10.0)
    assert (message.angle_min, message.angle_max, message.angle_step) == pytest.approx(
        (-math.pi / 2, math.pi / 2, math.pi / 2)
    )
    assert list(message.ranges) == pytest.approx([math.inf, 3.0, math.inf])
    assert list(message.intensities) == [0.0] * 3
    assert message.frame == "rig::l::s"
    assert message.world_pose.position.z == 1.0


def test_nobody_listening_costs_no_rays_and_changes_no_truth(monkeypatch: pytest.MonkeyPatch) -> None:
    from gz_course.sim.gz.transport import NodeOptions, Scope

    casts = []
    original = Lidar.ranges
    monkeypatch.setattr(Lidar, "ranges", lambda self: casts.append(1) or original(self))
    ends = []
    for listen in (False, True):
        with Node(NodeOptions(scope=Scope.PROCESS)) as own:
            world = World.load("lidar_room.sdf", node=own)
            if listen:
                own.subscribe(LaserScan, "/lidar/scan", lambda message: None)
            command = Twist()
            command.linear.x = 0.4
            own.advertise("/model/robot/cmd_vel", Twist).publish(command)
            world.step(1000)
            ends.append(world.data.qpos.tobytes() + world.data.qvel.tobytes())
            assert len(casts) == (11 if listen else 0)
    assert ends[0] == ends[1]


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("<max>10</max>", "<max>0.1</max>", "0 <= min < max"),
        ("<samples>3<", "<samples>0<", "<samples> must be at least 1"),
        ("<min_angle>-1.5707963267948966", "<min_angle>2", "must not be above <max_angle>"),
        ("lidar>", "lidr>", "gpu_lidar sensor 's' has no <lidar> element; give it one with <scan> and <range>"),
        ("range>", "rnge>", "0 <= min < max, got min 0.0 and max 0.0"),
    ],
)
def test_an_impossible_lidar_is_left_out_and_the_rest_runs(
    load_text: Load, node: Node, old: str, new: str, sentence: str
) -> None:
    text = rig().replace(old, new)
    world = load_text(text, node=node)
    (warning,) = [each for each in world.warnings if sentence in each]
    assert warning.startswith("<string>:") and warning.endswith("sensor 's' of model 'rig' stays silent")
    assert not any(each.endswith("/scan") for each in node.topic_list())
    world.step(10)
    with pytest.raises(SdfError, match=re.escape(sentence)):
        load_text(text, strict=True)


def test_angles_in_degrees_are_named(load_text: Load) -> None:
    assert load_text(rig()).warnings == []
    warnings = load_text(rig().replace("<min_angle>-1.5707963267948966", "<min_angle>-90")).warnings
    assert len(warnings) == 1 and "angles are in radians, not degrees" in warnings[0]
    assert warnings[0].startswith("<string>:")


def test_a_world_without_the_sensors_system_says_why_its_lidar_is_silent(
    world_text: Callable[..., str],
) -> None:
    text = world_text(rig()).replace('<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>', "")
    warnings = World.from_string(text).warnings
    assert len(warnings) == 1 and "does not load the Sensors system" in warnings[0]


def test_sensor_types_nothing_here_can_do_are_named(load_text: Load) -> None:
    warnings = load_text(rig(kind="gpu_lidr")).warnings
    assert any("did you mean 'gpu_lidar'" in warning for warning in warnings)


def test_points_stand_where_the_ranges_end(load_text: Load, node: Node) -> None:
    from gz_course.sim.gz.msgs.pointcloud_packed_pb2 import PointCloudPacked

    vertical = "<vertical><samples>2</samples><min_angle>-0.1</min_angle><max_angle>0.15</max_angle></vertical>"
    shiny = wall("visual", 3.1).replace("</visual>", "<laser_retro>7.5</laser_retro></visual>")
    world = load_text(rig(vertical=vertical, samples=3) + shiny, node=node)
    clouds: list[Any] = []
    scans: list[Any] = []
    node.subscribe(PointCloudPacked, lidar_of(world).topic + "/points", clouds.append)
    world.step(1)
    node.subscribe(LaserScan, lidar_of(world).topic, scans.append)
    world.step(100)
    assert len(clouds) == 2 and len(scans) == 1
    cloud = clouds[-1]
    assert [(f.name, f.offset, f.datatype, f.count) for f in cloud.field] == [
        ("x", 0, 6, 1), ("y", 4, 6, 1), ("z", 8, 6, 1), ("intensity", 16, 6, 1), ("ring", 24, 3, 1),
    ]  # fmt: skip
    assert (cloud.width, cloud.height, cloud.point_step, cloud.row_step, cloud.is_dense) == (3, 2, 32, 96, False)
    kinds = {"names": ["x", "y", "z", "i", "ring"], "formats": ["<f4"] * 4 + ["<u2"], "offsets": [0, 4, 8, 16, 24]}
    points = np.frombuffer(cloud.data, np.dtype({**kinds, "itemsize": 32}))  # type: ignore[call-overload]
    assert points["ring"].tolist() == [0, 0, 0, 1, 1, 1]
    for row, elevation in ((0, -0.1), (1, 0.15)):
        ahead = points[3 * row + 1]
        assert ahead.tolist()[:3] == pytest.approx((3, 0, 3 * math.tan(elevation)), abs=1e-6)
        assert ahead["i"] == 7.5
    assert not np.isfinite(points["y"][[0, 2, 3, 5]]).any()
    assert list(scans[0].intensities) == [0, 7.5, 0, 0, 7.5, 0]


def test_a_lidar_has_a_bounded_number_of_beams(load_text: Load) -> None:
    vertical = "<vertical><samples>1000</samples><min_angle>-0.2</min_angle><max_angle>0.3</max_angle></vertical>"
    (warning,) = load_text(rig(vertical=vertical, samples=10000)).warnings
    assert "2000000 beams at most, this one has 10000000" in warning


def test_masked_visuals_are_not_scanned(load_text: Load) -> None:
    hidden = wall("visual", 2.1).replace("</visual>", "<visibility_flags>4</visibility_flags></visual>")
    masked = rig(noise="<visibility_mask>3</visibility_mask>")
    assert lidar_of(load_text(masked + hidden + wall("visual", 3.1))).ranges()[1] == pytest.approx(3.0)
    assert lidar_of(load_text(rig() + hidden + wall("visual", 3.1))).ranges()[1] == pytest.approx(2.0)
