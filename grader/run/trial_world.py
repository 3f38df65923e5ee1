"""The world of a run, with its models at the poses of the trial, before simulated time begins.

Used wherever a run needs its simulator; the world then belongs to the caller.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.trial import Trial
from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import Diagnostics, SimError
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.reader import read_world_file
from gz_course.sim.gz.sim.sdf.resources import find_world
from gz_course.sim.gz.sim.world import World

if TYPE_CHECKING:
    from gz_course.sim.gz.transport import Node


def load_trial_world(exercise: Exercise, trial: Trial, node: Node | None) -> World:
    """Return the world of `exercise` modified by `trial`. Raises ManifestError if a world or model is missing."""
    own = trial.source if trial.world is not None or trial.poses else None  # else the exercise defines everything
    where = f"{own or exercise.manifest}, trial {trial.name}"
    try:
        diagnostics = Diagnostics()
        description = read_world_file(find_world(exercise.world), diagnostics)
        models = {model.name: model for model in description.models}
        for name, pose in trial.poses.items():
            if name not in models:
                hint = did_you_mean(name, models, listing="known")
                raise ManifestError(f"{where}: {exercise.world} has no model {name!r} to place{hint}")
            models[name].pose = Pose.from_rpy(pose[:3], pose[3:])
        world = World(description, diagnostics, seed=trial.seed, node=node)
    except SimError as error:
        raise ManifestError(f"{where}: {error}") from None
    names = world.model_names()
    if exercise.robot not in names:
        world.close()
        raise ManifestError(
            f"{where}: the world {exercise.world} has no moving model {exercise.robot!r}"
            f"{did_you_mean(exercise.robot, names, listing='known')}"
        )
    return world
