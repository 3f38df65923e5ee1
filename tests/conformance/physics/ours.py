"""Runs a scene here."""

from __future__ import annotations

import math

import numpy as np

from gz_course.sim.gz.sim.driving.joint_command import JointCommand
from gz_course.sim.gz.sim.physics.joint_axis import find_axes
from gz_course.sim.gz.sim.pose import rotate
from gz_course.sim.gz.sim.systems.diff_drive import DiffDrive
from gz_course.sim.gz.sim.world import World
from gz_course.tests.conformance.physics.scene import Action, Drive, Kick, Scene, Track


def run(scene: Scene) -> Track:
    world = World.from_string(scene.sdf, file_name=scene.name)
    samples = []
    axes = [find_axes(world.model, name)[0] for name in scene.joints]
    links = [name.split("::", 1) for name in scene.links]
    for actions, steps in scene.phases():
        for action in actions:
            _act(world, action)
        for _ in range(steps // scene.stride):
            world.step(scene.stride)
            sample: list[float] = []
            for model, link in links:
                pose = world.truth.link_pose(model, link)
                sample += [*pose.position.tolist(), *pose.quaternion.tolist()]
            for axis in axes:
                sample += [axis.read_position(world.data), axis.read_velocity(world.data)]
            assert all(map(math.isfinite, sample)), f"{scene.name}: not finite"
            samples.append(sample)
    return scene.track(samples)


def _act(world: World, action: Action) -> None:
    if isinstance(action, Drive):
        drives = (each for each in world.systems if isinstance(each, DiffDrive))
        next(each for each in drives if each._model.name == action.model).command(action.linear, action.angular)
    elif isinstance(action, Kick):
        model = world.truth.find_model(action.model)
        joint = world.model.joint(f"{action.model}::{model.links[0].name}#free")
        first = int(joint.dofadr[0])
        world.data.qvel[first : first + 3] = action.linear
        turn = world.truth.link_pose(action.model, model.links[0].name).inverse().quaternion
        world.data.qvel[first + 3 : first + 6] = rotate(turn, np.array(action.angular))
    else:
        model, _, name = action.joint.partition("::")
        commands = (each for each in world.systems if isinstance(each, JointCommand))
        of_model = (each for each in commands if each.scope.model.name == model)
        next(each for each in of_model if each.joints[0].name == name).command(action.value)
