"""Entities: every part of a world has its own id, which is removed with it and not used again."""

from __future__ import annotations

from collections.abc import Callable

from gz_course.sim.gz.sim.entities import Entities
from gz_course.sim.gz.sim.world import World

INSIDE = """
<light name="lamp" type="point"/>
<model name="lamp_post"><link name="pole"><light name="lamp" type="point"/><visual name="v"><geometry><box/></geometry>
  </visual></link></model>
<model name="a"><link name="l"/></model><model name="b"><link name="l"/></model>
<joint name="tie" type="fixed"><parent>a</parent><child>b</child></joint>
"""


def test_everything_is_numbered_once(load_text: Callable[..., World]) -> None:
    entities = load_text(INSIDE).entities
    numbers = [each.number for each in entities]
    assert numbers == list(range(1, len(numbers) + 1))
    assert entities.number("world", "w") == 1
    for kind, *path in (
        ("light", "lamp"),
        ("light", "lamp_post", "pole", "lamp"),
        ("visual", "lamp_post", "pole", "v"),
        ("joint", "tie"),
    ):
        found = entities.find(entities.number(kind, *path))
        assert found is not None
        assert (found.kind, found.path, found.name) == (kind, tuple(path), path[-1])
    assert entities.number("light", "nowhere") == 0
    assert entities.find(0) is None


def test_a_model_takes_its_lights_along_and_a_light_no_model(load_text: Callable[..., World]) -> None:
    entities: Entities = load_text(INSIDE).entities
    post = [each.number for each in entities if each.path[0] == "lamp_post"]
    assert sorted(entities.remove("model", "lamp_post")) == post
    assert len(post) == 4
    assert entities.number("light", "lamp") > 0
    assert entities.remove("light", "lamp") != []
    assert entities.number("light", "lamp") == 0
    assert entities.remove("model", "lamp") == []


def test_a_number_is_not_given_again(load_text: Callable[..., World]) -> None:
    world = load_text(INSIDE)
    entities = world.entities
    (light,) = entities.remove("light", "lamp")
    last = max(each.number for each in entities)
    assert entities.add_light(world.description.lights[0]) > max(last, light)
    entities.restart(world.description)
    assert entities.number("light", "lamp") == light
