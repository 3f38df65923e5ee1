"""Submissions that are launch files, really launched: what is served, what is told, and that everything ends."""

import dataclasses
import hashlib
import textwrap
from pathlib import Path

import psutil
import pytest

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.trial import Trial
from gz_course.grader.record.reading import Recording
from gz_course.grader.run.session import run
from gz_course.grader.submission import Submission

ROOT = Path(__file__).parents[4]
HEAD = """
import sys
from pathlib import Path
from launch import LaunchDescription
from launch.actions import *
from launch.event_handlers import *
from launch.substitutions import *
from launch_ros.actions import Node
HERE = Path(__file__).parent
CLOCK = "/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"
def gz(*words): return ExecuteProcess(cmd=["gz", *words], output="screen")
def bridge(*words): return Node(package="ros_gz_bridge", executable="parameter_bridge", arguments=[*words])
def generate_launch_description():
    return LaunchDescription([
"""
BOX = (
    "<sdf version='1.9'><model name='parcel'><link name='l'><inertial><mass>1</mass></inertial><collision name='c'>"
    "<geometry><box><size>1 1 1</size></box></geometry></collision></link></model></sdf>"
)
WORLD = "<sdf version='1.9'><world name='mine'>{}</world></sdf>"


@dataclasses.dataclass
class Launched:
    """What is on record of one run."""

    recording: Recording
    pace: str

    @property
    def facts(self):
        return self.recording.facts()["launch"]

    @property
    def log(self):
        return "\n".join(line.text for line in self.recording.lines("log/student"))


@pytest.fixture
def launch(tmp_path, monkeypatch):
    """Run the entities of a launch file; afterwards nothing is left of it."""
    (tmp_path / "tmp").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "tmp"))
    before = set(psutil.Process().children(recursive=True))
    exercise = dataclasses.replace(find_exercise("02_launch", ROOT), duration=0.5)

    def call(entities, duration=0.5, parameters=None, **files):
        text = HEAD + textwrap.indent(textwrap.dedent(entities), "        ") + "\n    ])\n"
        given = {name.replace("_dot_", "."): data.encode() for name, data in files.items()}
        files = {"bringup.launch.py": text.encode()} | given
        submission = Submission(tmp_path, "bringup.launch.py", hashlib.sha256(text.encode()).hexdigest(), None, files)
        path = tmp_path / "run.rrd"
        trial = Trial("made", 0, parameters=parameters or {})
        made = run(dataclasses.replace(exercise, duration=duration), submission, trial, "lockstep", path, "D")
        with made.recorder:
            pass
        return Launched(Recording(path), made.pace)

    yield call
    assert not set(psutil.Process().children(recursive=True)) - before
    assert [path.name for path in (tmp_path / "tmp").iterdir()] == []


def test_three_programs_and_what_became_of_them(launch):
    run = launch(
        """
        gz("sim", "-s", "-r", "shapes.sdf"),
        bridge(CLOCK),
        ExecuteProcess(cmd=[sys.executable, str(HERE / "stopwatch.py"), "--ros-args", "-p", "use_sim_time:=true"]),
        """
    )
    assert run.pace == "lockstep"
    facts = run.facts
    assert [s["world"] for s in facts["simulators"]] == ["shapes.sdf"]
    assert (facts["simulator_at_end"], facts["bridges_at_end"], facts["running"]) == ("shapes.sdf", 1, True)
    assert (facts["exit_code"], facts["ended_itself"], facts["left"], facts["escalated"]) == (0, True, [], [])
    (entry,) = facts["bridges_started"][0]["entries"]
    assert (entry["ros_topic"], entry["direction"]) == ("/clock", "GZ_TO_ROS")
    told = run.recording.signal("topics/stopwatch/data")
    assert told.values.tolist() == pytest.approx([0.1, 0.2, 0.3, 0.4, 0.5])
    assert (told.times / 1e9).tolist() == pytest.approx(told.values.tolist())
    assert "[parameter_bridge-2] [INFO] [ros_gz_bridge]: ready: 1 bridge" in run.log
    assert "pid [...]" in run.log and "Traceback" not in run.log


def test_a_paused_world_tells_its_time_and_stays_where_it_is(launch):
    run = launch('gz("sim", "-s", "shapes.sdf"), bridge(CLOCK),')
    assert run.facts["simulators"][0]["paused"]
    assert run.recording.facts()["sim_seconds"] == 0.0
    (bridge,) = run.recording.facts()["bridges"]
    assert bridge["to_ros"] == 10
    assert "world 'shapes' is paused; start it with -r" in run.log


def test_programs_complain_as_they_always_do(launch):
    run = launch(
        """
        gz("sim", "-s", "-r", "lidar_rom.sdf"),
        gz("sim", "--nonsense"),
        bridge("--strict", "/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clok"),
        bridge("--strict"),
        """
    )
    assert "did you mean 'lidar_room.sdf'?" in run.log
    assert "there is no option '--nonsense'" in run.log
    assert "gz.msgs.Clok" in run.log and "gz.msgs.Clock" in run.log
    codes = sorted((each["program"], each["code"]) for each in run.facts["ended_early"])
    assert codes == [("gz", 1), ("gz", 109), *[("ros_gz_bridge.parameter_bridge", 2)] * 2]
    assert run.facts["simulators"] == [] and run.facts["simulator_at_end"] == ""
    assert not run.facts["running"], "a launch with nothing left to do ends"


def test_a_world_is_one_that_was_handed_in_and_never_a_file_from_elsewhere(launch, tmp_path):
    secret = tmp_path / "secret.sdf"
    secret.write_text(WORLD.format("<!-- the answer is 42 -->"))
    run = launch(f'gz("sim", "-s", "-r", {str(secret)!r}),')
    assert [s["ran"] for s in run.facts["simulators"]] == [False]
    assert "is neither a built-in world nor one of the files handed in" in run.log and "the answer" not in run.log


def test_a_world_that_was_handed_in_is_run(launch):
    run = launch('gz("sim", "-s", "-r", str(HERE / "mine.sdf")),', mine_dot_sdf=WORLD.format(""))
    assert run.facts["simulator_at_end"] == "mine.sdf"
    assert run.recording.facts()["sim_seconds"] == 0.5


def test_a_world_brings_models_of_its_own(launch):
    run = launch(
        """
        SetEnvironmentVariable("GZ_SIM_RESOURCE_PATH", str(HERE)),
        gz("sim", "-s", "-r", str(HERE / "mine.sdf")),
        """,
        **{
            "mine_dot_sdf": WORLD.format(
                "<include><uri>model://parcel</uri></include><include><uri>heap.sdf</uri></include>"
                "<include><uri>model://nothing</uri></include><include><uri>model://crate</uri></include>"
            ),
            "parcel/model_dot_config": "<model><sdf version='1.9'>model.sdf</sdf></model>",
            "parcel/model_dot_sdf": BOX,
            "heap_dot_sdf": BOX.replace("parcel", "heap"),
        },
    )
    assert run.facts["simulator_at_end"] == "mine.sdf" and run.recording.facts()["sim_seconds"] == 0.5
    assert run.recording.signals() and run.recording.has("truth/parcel/x") and run.recording.has("truth/heap/x")
    assert "mine.sdf:1: the include is skipped: model 'model://nothing' was not found" in run.log


ROBOT = """<robot name='robot' xmlns:xacro='http://ros.org/wiki/xacro'><xacro:property name='m' value='1'/>
<link name='l'><inertial><mass value='${m * 2}'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>
<collision><geometry><mesh filename='part.stl'/></geometry></collision></link></robot>"""
STL = """solid part
{}endsolid part
"""
FACET = "facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n"
CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]


CREATE = 'Node(package="ros_gz_sim", executable="create", arguments=[{}])'
WAYS = {
    "file": CREATE.format('"-file", str(HERE / "robot.urdf.xacro")'),
    "string": CREATE.format(f'"-string", {BOX!r}'),
    "param": CREATE.format('"-param", "model"').replace("])", f'], parameters=[{{"model": {BOX!r}}}])'),
    "spawn_entity": CREATE.replace("create", "spawn_entity").format(
        '"--name", "box", "--sdf_filename", str(HERE / "box.sdf"), "--pos", "1", "0", "3"'
    ),
}


@pytest.mark.parametrize(
    "way", ["file", "spawn_entity", *(pytest.param(w, marks=pytest.mark.proof) for w in ("string", "param"))]
)
def test_models_come_in_every_way_that_create_knows(launch, way):
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    loops = ("".join("vertex {} {} {}\n".format(*CORNERS[corner]) for corner in face) for face in faces)
    run = launch(
        f'gz("sim", "-s", "-r", "empty.sdf"), {WAYS[way]},',
        robot_dot_urdf_dot_xacro=ROBOT,
        part_dot_stl=STL.format("".join(map(FACET.format, loops))),
        box_dot_sdf=BOX,
    )
    assert run.facts["calls"] == ["create: done"], run.log
    assert "Entity creation successful" in run.log and "is left out" not in run.log


def test_create_puts_a_model_into_the_world_and_others_start_when_it_has(launch):
    run = launch(
        f"""
        gz("sim", "-s", "-r", "empty.sdf"),
        create := Node(package="ros_gz_sim", executable="create", arguments=["-string", {BOX!r}, "-z", "3"]),
        RegisterEventHandler(OnProcessExit(target_action=create, on_exit=[bridge(CLOCK)])),
        """
    )
    assert run.facts["calls"] == ["create: done"]
    assert run.facts["ended_early"] == [{"code": 0, "program": "ros_gz_sim.create"}]
    (bridge,) = run.recording.facts()["bridges"]
    assert bridge["to_ros"] == 50, "time had not begun before the bridge stood"
    assert "Entity creation successful" in run.log


@pytest.mark.parametrize("arguments", ["-r", ""], ids=["running", "paused"])
def test_create_that_waits_for_a_description_holds_nobody_up_and_ends_on_ctrl_c(launch, arguments):
    run = launch(
        f"""
        gz("sim", "-s", *"{arguments}".split(), "empty.sdf"),
        {CREATE.format('"-topic", "/nobody_publishes"')},
        ExecuteProcess(cmd=["ros2", "run", "ros_gz_sim", "create", "-topic", "/nobody_either"]),
        bridge(CLOCK),
        """
    )
    assert run.pace == "lockstep"
    assert (run.log.count("Waiting messages on topic"), run.log.count("no message came")) == (2, 0)
    facts = run.facts
    assert (facts["exit_code"], facts["left"], facts["escalated"], facts["ended_early"]) == (0, [], [], [])


def test_what_python_starts_in_a_session_of_its_own_is_told_from_an_action(launch):
    run = launch(
        """
        OpaqueFunction(function=lambda context: __import__("subprocess").Popen(
            ["gz", "sim", "-s", "-r", "empty.sdf"], start_new_session=True) and None),
        bridge(CLOCK),
        """
    )
    assert run.facts["by_python"] == ["gz"]


def test_a_second_simulator_stands_still_beside_the_first(launch):
    run = launch('gz("sim", "-s", "-r", "shapes.sdf"), gz("sim", "-s", "-r", "shapes.sdf"),')
    assert [s["ran"] for s in run.facts["simulators"]] == [True, True]
    assert run.facts["left"] == []


def test_a_simulator_that_ends_by_itself_is_noticed(launch):
    run = launch('gz("sim", "-s", "-r", "--iterations", "100", "shapes.sdf"), bridge(CLOCK),')
    assert run.facts["simulator_at_end"] == ""
    assert run.recording.facts()["sim_seconds"] == 0.1
    assert run.facts["running"], "the bridge is still there"


def test_nothing_of_the_simulator_can_be_reached_but_through_the_bridge(launch):
    run = launch(
        f"""
        gz("sim", "-s", "-r", "lidar_room.sdf"),
        create := Node(package="ros_gz_sim", executable="create", arguments=["-string", {BOX!r}, "-z", "3"]),
        RegisterEventHandler(OnProcessExit(target_action=create, on_exit=[gz("topic", "-l"), gz("service", "-l")])),
        """
    )
    assert run.facts["simulator_at_end"] == "lidar_room.sdf"
    shown = {line for line in run.log.splitlines() if "/world/" in line or "/model/" in line or "/lidar" in line}
    # The one that a launch may use; whether it is offered already when they look is no law.
    assert {line.partition("] ")[2] for line in shown} <= {"/world/lidar_room/control"}


def test_what_is_no_python_is_not_waited_for_and_ended(launch):
    run = launch('gz("sim", "-s", "-r", "shapes.sdf"), ExecuteProcess(cmd=["sleep", "600"]),')
    assert run.facts["simulator_at_end"] and run.facts["ended_itself"]


# It listens no longer when the run begins: a Ctrl-C that came earlier would end it.
DEAF = """
deaf := ExecuteProcess(cmd=["sh", "-c", "trap '' INT; echo deaf; exec sleep 600"], name="deaf", sigterm_timeout="1"),
RegisterEventHandler(OnProcessIO(target_action=deaf, on_stdout=lambda event: [gz("sim", "-s", "-r", "shapes.sdf")])),
"""


def test_one_that_does_not_listen_to_ctrl_c_is_named(launch, monkeypatch):
    monkeypatch.setattr("gz_course.grader.kinds.launch.launch_run_loop.FAIR_SHARE", 0.0)
    run = launch(DEAF)
    assert run.facts["escalated"] == ["deaf-1"]
    assert run.facts["ended_itself"]


def test_a_simulator_that_runs_on_after_ctrl_c_is_named(launch):
    run = launch(
        """
        ExecuteProcess(cmd=["setsid", "gz", "sim", "-s", "-r", "shapes.sdf"]),
        ExecuteProcess(cmd=["sleep", "600"]),
        """
    )
    assert run.facts["left"] == ["shapes.sdf"]


def test_a_program_of_python_that_runs_on_after_ctrl_c_is_named(launch):
    echo = '["ros2", "topic", "echo", "/clock", "rosgraph_msgs/msg/Clock"]'
    popen = f'__import__("subprocess").Popen({echo}, start_new_session=True)'
    run = launch(f'gz("sim", "-s", "-r", "shapes.sdf"), *([] if {popen} else []),')
    assert run.facts["by_python"] == run.facts["left"] == ["ros2"]


def test_an_error_in_the_launch_file_is_on_record_with_its_line(launch):
    run = launch('gz("sim", "-s", robot_description),')
    assert run.facts["error"].startswith("/submission/bringup.launch.py:")
    assert "NameError: name 'robot_description' is not defined" in run.facts["error"]
    assert run.facts["exit_code"] == 1


def test_what_a_timer_starts_is_waited_for(launch):
    run = launch('gz("sim", "-s", "-r", "shapes.sdf"), TimerAction(period=1.5, actions=[bridge(CLOCK)]),')
    (bridge,) = run.recording.facts()["bridges"]
    assert bridge["to_ros"] == 50, "time had not begun before the bridge stood"


@pytest.mark.proof
def test_a_world_that_comes_after_the_launch_was_given_up(launch, monkeypatch):
    monkeypatch.setattr("gz_course.grader.kinds.launch.launch_run_loop.SIMULATOR_PATIENCE", 0.5)
    late = "trap 'gz sim -s -r shapes.sdf' INT; sleep 3600 & wait"
    run = launch(f'ExecuteProcess(cmd=["bash", "-c", "{late}"], output="screen"),')
    assert [s["ran"] for s in run.facts["simulators"]] in ([], [False])
    assert (run.facts["simulator_at_end"], run.recording.facts()["sim_seconds"]) == ("", 0.0)


@pytest.mark.proof
def test_a_launch_without_time_to_end_is_no_fault_of_its_own(launch, monkeypatch):
    monkeypatch.setattr("gz_course.grader.kinds.launch.launch_run_loop.FAIR_SHARE", 100.0)
    with pytest.raises(InfrastructureError, match=r"too busy: deaf-1 could use .* of the 1 s it is given after Ctrl-C"):
        launch(DEAF)
