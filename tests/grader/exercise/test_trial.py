"""A trial: its seed decides the scripted commands and nothing else does; its file; what it changes in a run."""

import dataclasses
import re
import shutil

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.trial import (
    PUBLIC,
    SCRIPT_SPREAD,
    ScriptedCommand,
    ScriptedParameter,
    Trial,
    chosen_trials,
    load_trials,
    numbered,
)
from gz_course.grader.run.trial_world import load_trial_world

COMMAND = ScriptedCommand(at=0.5, topic="/model/robot/cmd_vel", linear_x=0.3, angular_z=-0.25)


@given(st.integers())
def test_same_seed_same_command_and_always_near_the_script(seed):
    varied = Trial("public", seed).vary(COMMAND)
    assert varied == Trial("hidden", seed).vary(COMMAND)
    assert (varied.at, varied.topic) == (COMMAND.at, COMMAND.topic)
    for now, before in ((varied.linear_x, COMMAND.linear_x), (varied.angular_z, COMMAND.angular_z)):
        assert abs(now - before) <= abs(before) * SCRIPT_SPREAD + 1e-12


def test_other_seeds_and_other_moments_vary_differently():
    speeds = {Trial("public", seed).vary(COMMAND).linear_x for seed in range(50)}
    assert len(speeds) == 50
    later = ScriptedCommand(**COMMAND.__dict__ | {"at": 4.5})
    assert Trial("public", 0).vary(later).linear_x != Trial("public", 0).vary(COMMAND).linear_x


def test_known_values_do_not_drift():
    """A stored grade is only worth something as long as its seed means the same run."""
    varied = Trial("public", 7).vary(COMMAND)
    assert (round(varied.linear_x, 6), round(varied.angular_z, 6)) == (0.315235, -0.210962)


GOOD = """\
[[trial]]
name = "north"
seed = 7
world = "empty.sdf"
duration = 3
tick = 0.25
poses = { robot = [-2, 1, 0, 0, 0, 1.5] }
parameters = { speed = 0.4, names = ["a"] }
visibility = "after the deadline"

[[trial.script]]
at = 1
topic = "/cmd_vel"
linear_x = 0.3
angular_z = 0

[[trial.script]]
at = 5
node = "/driver"
parameter = "speed"
value = 0.2

[[trial]]
name = "as_it_is"
"""


@pytest.fixture
def read(tmp_path):
    def load(text=GOOD):
        (tmp_path / "trials.toml").write_text(text)
        return load_trials(tmp_path / "trials.toml")

    return load


def test_every_key_is_read_and_only_the_name_is_needed(read):
    north, plain = read()
    assert north == Trial(
        "north",
        7,
        "empty.sdf",
        duration=3,
        poses={"robot": (-2, 1, 0, 0, 0, 1.5)},
        script=(ScriptedCommand(1, "/cmd_vel", 0.3, 0), ScriptedParameter(5, "/driver", "speed", 0.2)),
        parameters={"speed": 0.4, "names": ["a"]},
        tick=0.25,
        visibility="after the deadline",
    )
    assert plain == Trial("as_it_is", 0, visibility="never")


def test_a_trial_changes_what_it_names_and_nothing_else(read, root):
    exercise = find_exercise("03_teleop", root)
    north, plain = read()
    assert plain.applied_to(exercise) == exercise
    changed = north.applied_to(exercise)
    assert (changed.world, changed.duration, changed.script) == ("empty.sdf", 3, north.script)
    assert changed.tick == 0.25
    kept = {name: getattr(exercise, name) for name in ("world", "duration", "script", "tick")}
    assert dataclasses.replace(changed, **kept) == exercise


def test_a_world_beside_the_file_is_that_one(read, tmp_path):
    (tmp_path / "empty.sdf").write_text("<sdf/>")
    assert read()[0].world == str(tmp_path / "empty.sdf")


def test_a_command_comes_from_gazebo_or_from_ros(read):
    text = '[[trial]]\nname = "driven"\n[[trial.script]]\nat = 1\n{} = "/cmd_vel"\nlinear_x = 0.3\nangular_z = 0\n'
    assert [read(text.format(key))[0].script[0].ros for key in ("topic", "ros_topic")] == [False, True]


def test_an_empty_script_is_a_robot_nobody_drives(read):
    assert read('[[trial]]\nname = "still"\nscript = []')[0].script == ()


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("seed = 7", "seed = 7.5", "trial 'north': seed must be a whole number"),
        ("seed = 7", "sed = 7", "trial 'north': unknown key 'sed'; did you mean 'seed'"),
        ("duration = 3", "duration = 0", "duration must be a finite number greater than 0"),
        ("tick = 0.25", "tick = 0", "tick must be a finite number greater than 0"),
        ("[-2, 1, 0, 0, 0, 1.5]", "[-2, 1]", "poses: robot must be a list of 6 numbers"),
        ('parameters = { speed = 0.4, names = ["a"] }', "parameters = 3", "parameters must be a table"),
        ('name = "north"', 'name = "../north"', "name must be letters"),
        ('name = "as_it_is"', 'name = "north"', "two trials are called 'north'"),
        ("at = 1", "att = 1", "lacks the key 'at'"),
        ('node = "/driver"', 'node = "driver"', "script 2: node must be the full name of a node, such as /driver"),
        ("value = 0.2", 'value = [0.2, "a"]', "script 2: value must be a truth value, a number, a text, or a list"),
        ("value = 0.2", "valu = 0.2", "script 2 lacks the key 'value'"),
        ("[[trial]]\n", "[[trail]]\n", "trial must be a list of tables"),
    ],
)
def test_an_author_s_mistake_is_told_with_its_trial(read, old, new, told):
    assert old in GOOD
    with pytest.raises(ManifestError, match=rf"trials\.toml.*{told}"):
        read(GOOD.replace(old, new))


def test_which_trials_are_meant(root, tmp_path):
    exercise = find_exercise("04_lidar_listener", root)
    public, hidden = chosen_trials(exercise, "public"), chosen_trials(exercise, "hidden")
    assert public == (PUBLIC,) and len(hidden) >= 2
    assert chosen_trials(exercise, "all") == public + hidden
    (tmp_path / "mine.toml").write_text(GOOD)
    assert [trial.name for trial in chosen_trials(exercise, str(tmp_path / "mine.toml"))] == ["north", "as_it_is"]
    with pytest.raises(UsageError, match="no file hiden with hidden trials"):
        chosen_trials(exercise, "hiden")


def test_a_copy_without_solutions_has_its_public_trials(root, tmp_path):
    shutil.copytree(root / "exercises" / "04_lidar_listener", tmp_path / "exercises" / "04_lidar_listener")
    exercise = find_exercise("04", tmp_path)
    assert chosen_trials(exercise, "all") == (PUBLIC,)
    with pytest.raises(UsageError, match=r"no file .*trials\.toml with hidden trials"):
        chosen_trials(exercise, "hidden")


@given(st.integers(), st.lists(st.integers(), min_size=1, max_size=5))
def test_the_seed_of_a_grading_is_added_to_that_of_each_trial(seed, seeds):
    trials = numbered(tuple(Trial(str(i), each) for i, each in enumerate(seeds)), seed)
    assert [trial.seed for trial in trials] == [each + seed for each in seeds]
    assert [trial.place for trial in trials] == [(i, len(seeds)) for i in range(1, len(seeds) + 1)]


def test_models_stand_where_the_trial_puts_them(root):
    exercise = find_exercise("04", root)
    pose = (1.0, -1.5, 0.2, 0.0, 0.0, 0.7)
    wall = (0.0, -2.0, 0.4, 0.0, 0.0, 0.0)
    world = load_trial_world(exercise, Trial("moved", 0, poses={"robot": pose, "wall_south": wall}), None)
    try:
        assert tuple(world.truth.pose("robot").position) == pose[:3]
        assert world.truth.pose("robot").yaw() == pytest.approx(0.7)
        assert tuple(world.truth.pose("wall_south").position) == wall[:3]
    finally:
        world.close()


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"poses": {"robt": (0,) * 6}}, r"trial bad: .* has no model 'robt' to place.*did you mean 'robot'"),
        ({"world": "lidar_rom.sdf"}, r"trial bad: .*lidar_rom\.sdf.*lidar_room"),
        ({"world": "empty.sdf"}, r"trial bad: .*no moving model 'robot'"),
    ],
)
def test_a_world_that_is_not_as_the_trial_says(root, change, told):
    trial = Trial("bad", 0, **change)
    with pytest.raises(ManifestError, match=told):
        load_trial_world(trial.applied_to(find_exercise("04", root)), trial, None)


@pytest.mark.parametrize("line", ['world = "lidar_rom.sdf"', "poses = { robt = [0, 0, 0, 0, 0, 0] }"])
def test_the_file_is_named_in_which_the_wrong_word_stands(root, tmp_path, line):
    file = tmp_path / "trials.toml"
    file.write_text(f'[[trial]]\nname = "bad"\n{line}\n')
    (trial,) = load_trials(file)
    with pytest.raises(ManifestError, match=f"^{re.escape(str(file))}, trial bad: "):
        load_trial_world(trial.applied_to(find_exercise("04", root)), trial, None)
