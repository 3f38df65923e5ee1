"""Namespaces and rules that reach more, or less, than they were meant for, and words with their values in one text."""

import pytest

from gz_course.grader.feedback.launch_files import launch_places

LAUNCH = """\
def follower(number):
    process = ExecuteProcess(cmd=["python3", "a.py", "--ros-args", "-r", f"__ns:=/robot{number}", "-r",
        f"front/odom:=/robot{number - 1}/odom"])
    node = Node(package="p", executable="e", arguments=["-x", f"{-1.2 * number}", *("-y", "0")])
    return [process, node]


def convoy(context):
    return [action for number in range(2, 4) for action in follower(number)]
"""
NODE = 'node.create_subscription(Odometry, "front/odom", heard, 10)\n'


def slips(text, node=NODE):
    return [each["said"] for each in launch_places(text.encode(), {"a.py": node.encode()})["launch_slips"]]


def test_a_right_file_has_none():
    assert slips(LAUNCH) == []
    grouped = "GroupAction([PushRosNamespace('robot2'), node])"
    assert slips(LAUNCH.replace("[process, node]", f"[process, {grouped}]")) == []
    once = "node = Node(package='p', executable='e')\nLaunchDescription([PushRosNamespace('convoy'), node])\n"
    assert slips(once) == []


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("[process, node]", '[PushRosNamespace(f"robot{number}"), node]', "put below the first"),
        ('f"front/odom:=', 'f"/front/odom:=', "write front/odom:=... without the /"),
        ('"-x", f"{-1.2 * number}"', 'f"-x {-1.2 * number}"', "-x and its value are two items"),
        ('"-x", f"{-1.2 * number}"', '"-x " + str(-1.2 * number)', "-x and its value are two items"),
        ('*("-y", "0")', '*("-y 0", "-z")', "'-y 0' is one word here"),
        (
            "number):\n    process",
            'number, words=["-a"]):\n    words += ["-b"]\n    process',
            "is made once",
        ),
        ("number):\n    process", 'number, words=["-a"]):\n    words = words + ["-b"]\n    process', ""),
    ],
)
def test_a_mistake_is_named(old, new, words):
    assert old in LAUNCH
    said = " ".join(slips(LAUNCH.replace(old, new)))
    assert words in said and bool(words) == bool(said)


def test_a_process_in_a_group_gets_no_namespace():
    wrong = LAUNCH.replace('"-r", f"__ns:=/robot{number}", ', "").replace(
        "[process, node]", "[node, GroupAction([PushRosNamespace(f'robot{number}'), process])]"
    )
    assert "reaches Node actions only" in slips(wrong)[0]
    assert slips(LAUNCH.replace('f"front/odom:=', 'f"/front/odom:='), NODE.replace('"front', '"/front')) == []


def test_a_return_inside_of_the_loop():
    loop = "def convoy(context):\n    actions = []\n    for i in range(3):\n        actions.append(follower(i))\n"
    text = LAUNCH[: LAUNCH.index("def convoy")] + loop
    assert slips(text + "    return actions\n") == []
    assert "ends in its first iteration" in slips(text + "        return actions\n")[0]


def test_a_namespace_in_the_environment():
    given = LAUNCH.replace('executable="e"', 'executable="e", additional_env={"ROS_NAMESPACE": "/robot2"}')
    assert any("ROS_NAMESPACE is a variable of ROS 1" in each for each in slips(given))


def test_a_rule_whose_names_are_exchanged():
    given = LAUNCH.replace("front/odom:=/robot{number - 1}/odom", "/robot{number - 1}/odom:=front/odom")
    found = slips(given, NODE + 'node.create_subscription(Odometry, "odom", heard, 10)\n')
    assert len(found) == 1 and "`front/odom:=` comes first" in found[0]
