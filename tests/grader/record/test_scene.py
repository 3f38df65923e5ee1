"""What a world looks like in a recording: surfaces of triangles are drawn as meshes, models come and go."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gz_course.grader.record import scene
from gz_course.grader.record.reading import Recording
from gz_course.grader.record.recorder import Recorder
from gz_course.sim.gz.sim.world import World

CONE = (
    "<sdf version='1.11'><world name='w'><model name='m'><static>1</static><link name='l'><visual name='v'><geometry>"
    "<cone><radius>0.5</radius><length>2</length></cone></geometry><material><diffuse>1 0 0.5 0.5</diffuse></material>"
    "</visual></link></model></world></sdf>"
)


def columns(archetype) -> dict[str, list]:
    return {str(batch.component_descriptor()): batch.as_arrow_array() for batch in archetype.as_component_batches()}


@pytest.mark.parametrize(("facets", "corners"), [(scene.FACETS, 3 * 64), (10, 34)])
def test_a_cone_is_a_mesh_of_its_colour(monkeypatch: pytest.MonkeyPatch, facets: int, corners: int) -> None:
    monkeypatch.setattr(scene, "FACETS", facets)
    (shape,) = World.from_string(CONE).truth.geometry()
    found = columns(scene.surface(shape.vertices, shape.triangles, shape.rgba))
    named = {key.rsplit(":", 1)[-1]: value for key, value in found.items()}
    positions = np.array(next(v for k, v in named.items() if k == "vertex_positions").to_pylist())
    triangles = np.array(next(v for k, v in named.items() if k == "triangle_indices").to_pylist())
    assert positions.shape == (corners, 3) and triangles.shape == (64, 3)
    assert positions.min(axis=0) == pytest.approx((-0.5, -0.5, -1)) and positions[:, 2].max() == pytest.approx(1)
    assert ("vertex_normals" in named) == (facets > 64)
    assert next(v for k, v in named.items() if k == "albedo_factor").to_pylist() == [0xFF008080]


BALL = (
    "<sdf version='1.11'><model name='{}'><pose>{} 0 9 0 0 0</pose><link name='l'><inertial><mass>1</mass></inertial>"
    "<visual name='v'><geometry><sphere><radius>0.1</radius></sphere></geometry></visual></link></model></sdf>"
)


def test_models_that_come_and_go_are_recorded_while_they_are_there(tmp_path: Path) -> None:
    world = World.from_string("<sdf version='1.11'><world name='w'/></sdf>")
    world.editor.spawn(BALL.format("first", 1))
    with Recorder(tmp_path / "run.rrd", "second") as recorder:
        drawn = scene.Scene(recorder, world)

        def step() -> None:
            world.step(10)
            recorder.set_time(world.sim_time_ns)
            drawn.tick()

        step()
        world.editor.spawn(BALL.format("second", 2))
        step()
        world.editor.remove("first")
        step()
        drawn.finish()
    recording = Recording(tmp_path / "run.rrd")
    times = {name: recording.signal(f"truth/{name}/x").times / 1e6 for name in ("first", "second")}
    assert times["first"].tolist() == [10, 20] and times["second"].tolist() == [20, 30]
    assert recording.entities("world/second/l/v") or recording.static("world/second/l/v")
    assert recording.signal("truth/second/distance").values[0] == 0
