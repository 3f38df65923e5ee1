"""`ros2 interface`: the installed definitions."""

import pytest
import yaml
from geometry_msgs.msg import Twist

from gz_course.sim.ros.ros2.command_line import main
from gz_course.sim.ros.ros2.interface import interface_names
from gz_course.sim.ros.ros2.message_text import TextFormat, to_yaml

ODOMETRY = """\
std_msgs/Header header
	builtin_interfaces/Time stamp
		int32 sec
		uint32 nanosec
	string frame_id
string child_frame_id
geometry_msgs/PoseWithCovariance pose
	Pose pose
		Point position
			float64 x
			float64 y
			float64 z
		Quaternion orientation
			float64 x 0
			float64 y 0
			float64 z 0
			float64 w 1
	float64[36] covariance
geometry_msgs/TwistWithCovariance twist
	Twist twist
		Vector3  linear
			float64 x
			float64 y
			float64 z
		Vector3  angular
			float64 x
			float64 y
			float64 z
	float64[36] covariance
"""


@pytest.fixture
def interface(capsys, monkeypatch):
    """Run `ros2 interface` in this process; return (exit code, stdout, stderr)."""
    monkeypatch.setattr("signal.signal", lambda number, handler: None)
    monkeypatch.setattr("gz_course.sim.ros.ros2.command_line.hand_over", lambda arguments: None)

    def run(*words):
        monkeypatch.setattr("sys.stdout.reconfigure", lambda **options: None, raising=False)
        code = main(["interface", *words])
        return (code, *capsys.readouterr())

    return run


def test_show_without_comments_is_the_tree_of_fields(interface):
    assert interface("show", "nav_msgs/msg/Odometry", "--no-comments") == (0, ODOMETRY, "")


def test_show_has_the_comments_of_the_definition_but_not_of_what_it_is_made_of(interface):
    text = interface("show", "nav_msgs/msg/Odometry")[1]
    assert text.startswith("# This represents an estimate of a position and velocity in free space.\n")
    assert "\t# " not in text
    assert "\t# " in interface("show", "nav_msgs/msg/Odometry", "--all-comments")[1]
    bare = "".join(f"{line}\n" for line in text.splitlines() if line and not line.startswith("#"))
    assert bare == ODOMETRY


def test_show_a_service_with_trailing_comments(interface):
    assert interface("show", "std_srvs/srv/SetBool", "--no-comments")[1] == (
        "bool data\n---\nbool success\nstring message\n"
    )
    assert "bool data # e.g. for hardware enabling / disabling\n---\n" in interface("show", "std_srvs/srv/SetBool")[1]


def test_show_reads_a_name_from_standard_input(ros2):
    assert ros2("interface", "show", "-", "--no-comments", stdin_text="std_msgs/msg/Bool\n") == (
        0,
        "bool data\n",
        "",
    )


@pytest.mark.proof
def test_every_installed_interface_is_shown_down_to_its_leaves(interface):
    """Below a field there are lines with more indentation exactly if the field is a message with fields."""
    for name in interface_names():
        code, text, errors = interface("show", name, "--no-comments")
        assert (code, errors) == (0, "")
        lines = text.splitlines()
        for line, following in zip(lines, [*lines[1:], ""], strict=False):
            kind = line.split()[0].partition("[")[0].partition("<")[0]
            depth, next_depth = line.count("\t"), following.count("\t")
            assert next_depth <= depth + 1
            assert (next_depth > depth) == (kind[0].isupper() or "/" in kind) or kind.endswith("Empty"), name


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("std_msgs/String", "Invalid name 'std_msgs/String'. Expected three parts separated by '/'; did you mean"),
        ("String", "Invalid name 'String'. Expected three parts separated by '/'"),
        ("std_msgs/message/String", "Invalid name 'std_msgs/message/String'. The second part must be one of msg, srv"),
        ("std_msg/msg/String", "Unknown package 'std_msg'; did you mean 'std_msgs'?"),
        ("std_msgs/msg/Strng", "Could not find the interface '"),
        ("std_msgs/msg/../String", "Invalid name"),
    ],
)
@pytest.mark.parametrize("verb", ["show", "proto"])
def test_an_unknown_interface_is_one_sentence(interface, verb, name, sentence):
    code, text, errors = interface(verb, name)
    assert (code, text, len(errors.splitlines())) == (1, "", 1)
    assert errors.startswith(sentence)


def test_list_has_a_heading_for_each_kind(interface):
    lines = interface("list")[1].splitlines()
    assert [line for line in lines if not line.startswith("    ")] == ["Messages:", "Services:", "Actions:"]
    assert {"    sensor_msgs/msg/LaserScan", "    std_srvs/srv/SetBool"} <= set(lines)
    assert interface("list", "-m")[1].splitlines() == lines[: lines.index("Services:")]


def test_package_and_packages(interface):
    assert interface("package", "std_srvs") == (
        0,
        "std_srvs/srv/Empty\nstd_srvs/srv/SetBool\nstd_srvs/srv/Trigger\n",
        "",
    )
    assert interface("package", "std_srvs", "-m") == (0, "", "")
    assert interface("package", "std_srv") == (1, "", "Unknown package 'std_srv'; did you mean 'std_srvs'?\n")
    both, with_messages = interface("packages")[1].split(), interface("packages", "--only-msgs")[1].split()
    assert both == sorted(both)
    assert "std_srvs" in set(both) - set(with_messages)


def test_proto_is_a_message_one_can_publish(interface):
    text = to_yaml(Twist(), TextFormat())
    assert interface("proto", "geometry_msgs/msg/Twist") == (0, f'"{text}"\n', "")
    assert interface("proto", "geometry_msgs/msg/Twist", "--no-quotes") == (0, text, "")
    assert yaml.safe_load(interface("proto", "std_srvs/srv/SetBool", "--no-quotes")[1]) == {"data": False}
