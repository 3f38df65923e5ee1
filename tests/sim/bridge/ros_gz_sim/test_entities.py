"""`remove`, `spawn_entity`, `delete_entity` and `set_entity_pose` against a real `gz sim`, found by `ros2 run`."""

import pytest

MODEL = "<model name='{}'><static>true</static><link name='l'/></model>"
LIGHT = "<light name='lamp' type='point'/>"


@pytest.fixture(scope="module")
def world(programs):
    programs.gz_sim(LIGHT + "".join(map(MODEL.format, ("one", "two", "three", "still"))))
    programs.scene()
    return programs


@pytest.fixture
def run(world):
    return lambda name, *words: world.finished(f"gz_course.sim.bridge.ros_gz_sim.{name}", *words)


def test_remove(world, run):
    program = world.ros2("run", "ros_gz_sim", "remove", "--ros-args", "-p", "world:=small", "-p", "entity_name:=one")
    assert program.wait() == 0, program.said
    assert "one" not in world.scene()
    assert run("remove", "-entity_name", "two")[0] == 0
    assert "two" not in world.scene()


def test_delete_entity_by_number(world, run):
    number = world.scene()["three"].id
    assert run("delete_entity", "--id", str(number), "--type", "2")[0] == 0
    assert "three" not in world.scene()


def test_spawn_and_move(world, run):
    text = f"<sdf version='1.9'>{MODEL.format('new')}</sdf>"
    assert run("spawn_entity", "--sdf_string", text, "--name", "moved", "--pos", "1", "2", "-3e0")[0] == 0
    pose = world.scene()["moved"].pose
    assert (pose.position.x, pose.position.y, pose.position.z) == (1.0, 2.0, -3.0)
    # 6 is the number of a model in the original program.
    words = ["--name", "moved", "--type", "6", "--pos", "4", "5", "6", "--quat", "0", "0", "2", "0"]
    assert run("set_entity_pose", *words)[0] == 0
    pose = world.scene()["moved"].pose
    assert (pose.position.x, pose.position.y, pose.position.z) == (4.0, 5.0, 6.0)
    assert abs(pose.orientation.z) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        (["remove"], 2, "there is nothing to remove"),
        (["remove", "-entity_name", "stil"], 1, "world 'small' has no model 'stil'; did you mean 'still'?"),
        (["remove", "-entity_name", "lamp"], 1, "'lamp' in world 'small' is a light: use delete_entity --name lamp"),
        (["delete_entity"], 2, "say which entity: give --name or --id, one of them"),
        (["delete_entity", "--name", "a", "--id", "1"], 2, "say which entity"),
        (["delete_entity", "--name", "a", "--type", "modl"], 2, "there is no type 'modl'; did you mean 'model'?"),
        (["delete_entity", "--name", "a", "--type", "link"], 2, "type must be model or light"),
        (["delete_entity", "--id", "999"], 1, "world 'small' has no model or light with the number 999"),
        (["set_entity_pose", "--name", "still"], 2, "there is no pose; give --pos"),
        (["set_entity_pose", "--name", "still", "--pos", "0", "0", "nan"], 2, "-pos must be a finite number"),
        (["set_entity_pose", "--name", "still", "--quat", "0", "0", "0", "0"], 2, "--quat must not be all zeros"),
        (["set_entity_pose", "--name", "stil", "--pos", "0", "0", "1"], 1, "did you mean 'still'?"),
        (["spawn_entity", "--name", "a"], 2, "say what to spawn"),
        (
            ["spawn_entity", "--sdf_filename", "a", "--quat", "0", "0", "0", "1", "--euler", "0", "0", "0"],
            2,
            "both given",
        ),
    ],
)
def test_what_goes_wrong(world, call, words, code, sentence):
    ended, said = call(f"gz_course.sim.bridge.ros_gz_sim.{words[0]}", *words[1:])
    assert (ended, sentence in said) == (code, True), said


@pytest.mark.parametrize("name", ["create", "remove", "spawn_entity", "delete_entity", "set_entity_pose", "gzserver"])
def test_help(call, name):
    code, said = call(f"gz_course.sim.bridge.ros_gz_sim.{name}", "--help")
    assert code == 0
    assert said.startswith(f"usage: {name} ")


def test_all_are_executables_of_the_package():
    from gz_course.sim.ros.ros2.packages import executables

    names = {path.name for path in executables("ros_gz_sim")}
    assert names == {"create", "remove", "spawn_entity", "delete_entity", "set_entity_pose", "gzserver"}
