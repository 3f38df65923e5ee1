"""The substitutions of Nav2's launch files write what Nav2's own ones write."""

from pathlib import Path

import pytest
import yaml

from gz_course.sim.ros.launch import LaunchContext
from gz_course.sim.ros.launch.conditions import IfCondition
from gz_course.sim.ros.launch.substitutions import LaunchConfiguration, SubstitutionFailure
from gz_course.sim.ros.nav2_common.launch import HasNodeParams, ParseMultiRobotPose, ReplaceString, RewrittenYaml

PARAMETERS = """\
amcl:
  ros__parameters:
    use_sim_time: false
    base_frame_id: base
    limits: [1, 2]
    scan: {topic: scan, use_sim_time: false}
"""


@pytest.fixture
def file(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    path = tmp_path / "nav2.yaml"
    path.write_text(PARAMETERS)
    return path


def context(**configurations):
    made = LaunchContext()
    made.launch_configurations.update(configurations)
    return made


def rewritten(*arguments, **options):
    of = context(sim="True", robot="r1", rate="20", gain="0.5")
    return yaml.safe_load(Path(RewrittenYaml(*arguments, **options).perform(of)).read_text())


def test_a_value_is_replaced_at_every_depth_and_the_file_stays(file):
    there = rewritten(source_file=str(file), param_rewrites={"use_sim_time": LaunchConfiguration("sim")})["amcl"]
    assert there["ros__parameters"]["use_sim_time"] is True
    assert there["ros__parameters"]["scan"] == {"topic": "scan", "use_sim_time": True}
    assert file.read_text() == PARAMETERS


def test_whole_paths_are_replaced_or_added(file):
    rewrites = {
        "amcl.ros__parameters.scan.topic": "/front",
        "amcl.ros__parameters.limits.1": LaunchConfiguration("rate"),
        "map_server.ros__parameters.yaml_filename": "hall.yaml",
        "amcl.nothing": "1",
    }
    there = rewritten(file, rewrites, convert_types=True)
    assert there["amcl"]["ros__parameters"]["scan"]["topic"] == "/front"
    assert there["amcl"]["ros__parameters"]["limits"] == [1, 20]
    assert there["map_server"] == {"ros__parameters": {"yaml_filename": "hall.yaml"}}
    assert set(there["amcl"]) == {"ros__parameters"}


@pytest.mark.parametrize(
    ("convert", "text", "value"),
    [(True, "20", 20), (True, "0.5", 0.5), (True, "x.y", "x.y"), (False, "20", "20"), (False, "FALSE", False)],
)
def test_types(file, convert, text, value):
    there = rewritten(file, {"base_frame_id": text}, convert_types=convert)
    assert there["amcl"]["ros__parameters"]["base_frame_id"] == value


def test_keys_and_the_root(file):
    there = rewritten(file, {}, root_key=LaunchConfiguration("robot"), key_rewrites={"amcl": "slam"})
    assert set(there) == {"r1"} and set(there["r1"]) == {"slam"}
    assert set(rewritten(file, {}, root_key="")) == {"amcl"}


def test_a_file_with_a_fault_is_named_with_the_line(file):
    file.write_text("amcl: [1\nb: 2\n")
    with pytest.raises(SubstitutionFailure, match=r"nav2\.yaml:2: this is no YAML: expected"):
        rewritten(file, {})
    file.write_text("- amcl\n")
    with pytest.raises(SubstitutionFailure, match="is a dictionary with names of nodes; this is a list"):
        rewritten(file, {})
    for kind in (lambda path: RewrittenYaml(path, {}), lambda path: ReplaceString(path, {}), HasNodeParamsOfAmcl):
        with pytest.raises(SubstitutionFailure, match=r"'/no/such\.yaml' cannot be read: No such file or directory"):
            kind("/no/such.yaml").perform(context())


def HasNodeParamsOfAmcl(path):
    return HasNodeParams(path, "amcl")


def test_words_are_replaced_if_the_condition_holds(file):
    replaced = ReplaceString(file, {"base": ["<", LaunchConfiguration("robot"), ">"]}, IfCondition("true"))
    assert yaml.safe_load(Path(replaced.perform(context(robot="r1"))).read_text())["amcl"]["ros__parameters"][
        "<r1>_frame_id"
    ] == "<r1>"  # fmt: skip
    assert ReplaceString(str(file), {"base": "x"}, IfCondition("false")).perform(context()) == str(file)


def test_whether_a_node_has_parameters(file):
    assert HasNodeParams(file, "amcl").perform(context()) == "True"
    assert HasNodeParams(file, "slam").perform(context()) == "False"
    file.write_text("")
    assert HasNodeParams(file, "amcl").perform(context()) == "False"


def test_poses_of_robots(monkeypatch):
    monkeypatch.setattr("sys.argv", ["ros2", "launch", "p", "f", "robots:=a={x: 1.0, yaw: 1.5}; b={y: 2.0};"])
    poses = ParseMultiRobotPose("robots").value()
    assert poses["a"] == {"x": 1.0, "y": 0.0, "z": 0.0, "roll": 0.0, "pitch": 0.0, "yaw": 1.5}
    assert poses["b"]["y"] == 2.0 and ParseMultiRobotPose("others").value() == {}
    monkeypatch.setattr("sys.argv", ["robots:=a"])
    with pytest.raises(ValueError, match="'a' is no pose of a robot; write it as robot1="):
        ParseMultiRobotPose("robots").value()


def test_nothing_else_is_left_behind(file):
    rewritten(file, {})
    assert len(list(file.parent.iterdir())) == 2
