"""WindEffects: the wind rises, and takes along what is exposed to it."""

from __future__ import annotations

import math

import pytest

from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.wind_pb2 import Wind
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.systems.beyond_the_course.wind_effects import WindEffects
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.systems.floating_world import body
from gz_course.tests.sim.gz.sim.systems.motion_world import plugin, world

WIND = "<wind><linear_velocity>3 4 1</linear_velocity></wind>"
EXPOSED = "<enable_wind>true</enable_wind>"


def windy(inside: str = "", wind: str = WIND, *, seed: int = 0) -> World:
    models = body(before=EXPOSED) + body(name="sheltered", pose="0 3 0 0 0 0")
    made = world(wind + plugin("WindEffects", inside) + models, gravity="0 0 0", seed=seed)
    assert not made.warnings
    return made


def system(made: World) -> WindEffects:
    return next(each for each in made.systems if isinstance(each, WindEffects))


def factor(inside: str) -> str:
    return f"<force_approximation_scaling_factor{inside}</force_approximation_scaling_factor>"


def test_the_wind_rises_and_moves_what_is_exposed() -> None:
    made = windy(factor(">0.5"))
    made.step(1500)
    rising = 1.0 - math.exp(-1.5)
    assert system(made).velocity == pytest.approx((3 * rising, 4 * rising, rising), rel=1e-3)
    # v' = k (w - v) with w = 1 - exp(-t)
    speed = 1.0 - 2.0 * math.exp(-0.75) + math.exp(-1.5)
    assert made.truth.velocity("a").linear == pytest.approx((3 * speed, 4 * speed, speed), rel=2e-3)
    assert not made.truth.velocity("sheltered").linear.any()
    made.reset()
    assert system(made).velocity == pytest.approx((3, 4, 1))


def test_the_wind_is_set_and_stopped_by_its_topic(node: Node) -> None:
    made = windy("<horizontal><magnitude><time_for_rise>0.01</time_for_rise></magnitude></horizontal>", "")
    made.attach(node)
    wind = node.advertise("/world/w/wind", Wind)
    message = Wind(enable_wind=True)
    message.linear_velocity.y = -2.0
    wind.publish(message)
    assert node.request("/world/w/wind_info", Empty(), Empty, Wind) == (True, message)
    made.step(200)
    assert system(made).velocity == pytest.approx((0, -2, 0), abs=1e-6)
    speed = made.truth.velocity("a").linear
    assert speed[1] < -0.1
    message.enable_wind = False
    wind.publish(message)
    made.step(100)
    assert made.truth.velocity("a").linear == pytest.approx(speed)


def test_sines_and_noise_are_added() -> None:
    rise = "<time_for_rise>0.001</time_for_rise>"
    magnitude = f"{rise}<sin><amplitude_percent>0.2</amplitude_percent><period>4</period></sin>"
    direction = f"{rise}<sin><amplitude>10</amplitude><period>4</period></sin>"
    inside = f"<horizontal><magnitude>{magnitude}{{}}</magnitude><direction>{direction}</direction></horizontal>"
    made = windy(inside.format(""))
    made.step(1000)
    angle = math.atan2(4, 3) + math.radians(10)
    assert system(made).velocity[:2] == pytest.approx((6 * math.cos(angle), 6 * math.sin(angle)))
    noise = "<noise type='gaussian'><mean>0</mean><stddev>0.3</stddev></noise>"
    speeds = []
    for seed in (1, 1, 2):
        made = windy(inside.format(noise), seed=seed)
        made.step(5)
        speeds.append(system(made).velocity.tolist())
    assert speeds[0] == speeds[1] != speeds[2]


@pytest.mark.parametrize(
    ("inside", "expected"),
    [
        ("><k>2</k><px>0 0 1 1</px><rz>0 0 0 0.5</rz>", 2 * (1 + 2 + 0.5)),
        ("><when xlt='1'>5</when><when xge='1' zle='0'>7</when>", 7.0),
        ("><when xlt='1'>5</when>", 0.0),
    ],
)
def test_the_factor_may_depend_on_the_place(inside: str, expected: float) -> None:
    models = body(before=EXPOSED, pose="2 0 0 0 0 0")
    made = world(
        "<wind><linear_velocity>1 0 0</linear_velocity></wind>" + plugin("WindEffects", factor(inside)) + models
    )
    made.step(1)
    assert made.data.xfrc_applied[1, 0] == pytest.approx(10.0 * expected * 0.001, abs=1e-12)


def test_a_link_states_it_before_its_model() -> None:
    model = body(before=EXPOSED).replace("<inertial>", "<enable_wind>false</enable_wind><inertial>")
    made = world(WIND + plugin("WindEffects") + model, gravity="0 0 0")
    made.step(10)
    assert not made.data.qvel.any()


def test_wind_without_its_system_is_told() -> None:
    assert "<wind> moves nothing because the world does not load the WindEffects system" in world(WIND).warnings[0]
    with pytest.raises(SdfError, match="WindEffects' <time_for_rise> must be greater than zero, got 0"):
        windy("<vertical><time_for_rise>0</time_for_rise></vertical>")
    with pytest.raises(SdfError, match="<force_approximation_scaling_factor> must not be negative, got -1"):
        windy(factor(">-1"))
