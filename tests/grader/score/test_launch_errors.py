"""Errors of launch files and of xacro: what is said beside the error itself."""

import pytest

from gz_course.grader.score.launch_errors import launch_meaning


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (
            "Included launch description missing required argument 'world' (description: 'World')",
            "world', default_value",
        ),
        ("launch configuration 'word' does not exist", "declares word"),
        ("Unknown substitution command [wheel_radius]. Valid commands are ['find']", "in braces, ${wheel_radius}"),
        ("the command 'xacro robot.urdf.xacro' failed: error: name 'radius' is not defined ", "xacro:property above"),
        ("unknown macro name: xacro:wheel", "no xacro:macro above is called wheel"),
        ("XML parsing error: unbound prefix: line 4, column 2", "xmlns:xacro"),
        ("XML parsing error: mismatched tag: line 60, column 4", "</link>"),
        ("[Errno 2] No such file or directory: 'gz sim -s -r lidar_room.sdf'", "each word by itself"),
        ("NameError: name 'bridge_file' is not defined", ""),
        ("[Errno 2] No such file or directory: 'gz'", ""),
    ],
)
def test_the_meaning_is_named(error, words):
    said = launch_meaning(error)
    assert words in said and bool(words) == bool(said)
