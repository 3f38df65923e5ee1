"""`ros2 node` against a running node."""

import pytest

ASKED = {
    "list": ["list"],
    "all": ["list", "-a"],
    "count": ["list", "-c"],
    "info": ["info", "/robot/driver"],
    "relative": ["info", "robot/driver"],
    "hidden": ["info", "/robot/driver", "--include-hidden"],
    "unknown": ["info", "/robot/drivr"],
}
PARAMETER_SERVICES = [
    ("describe_parameters", "rcl_interfaces/srv/DescribeParameters"),
    ("get_parameter_types", "rcl_interfaces/srv/GetParameterTypes"),
    ("get_parameters", "rcl_interfaces/srv/GetParameters"),
    ("get_type_description", "type_description_interfaces/srv/GetTypeDescription"),
    ("list_parameters", "rcl_interfaces/srv/ListParameters"),
    ("set_parameters", "rcl_interfaces/srv/SetParameters"),
    ("set_parameters_atomically", "rcl_interfaces/srv/SetParametersAtomically"),
]


@pytest.fixture(scope="module")
def answers(robot, run_together):
    return dict(zip(ASKED, run_together(*(["node", *words] for words in ASKED.values())), strict=True))


def test_list_names_the_nodes_but_not_hidden_ones(answers):
    code, text, errors = answers["list"]
    assert (code, errors) == (0, "")
    assert "/robot/driver" in text.split()
    assert "_ros2cli" not in text
    assert answers["count"][1] == f"{len(text.split())}\n"
    assert set(text.split()) <= set(answers["all"][1].split())


def test_info_tells_what_the_node_has_in_this_order(answers):
    services = "".join(f"    /robot/driver/{name}: {kind}\n" for name, kind in PARAMETER_SERVICES)
    assert answers["info"] == (
        0,
        "/robot/driver\n"
        "  Subscribers:\n    /robot/cmd_vel: geometry_msgs/msg/Twist\n"
        "  Publishers:\n    /parameter_events: rcl_interfaces/msg/ParameterEvent\n"
        "    /rosout: rcl_interfaces/msg/Log\n    /stamped: geometry_msgs/msg/PointStamped\n"
        f"  Service Servers:\n{services}"
        "    /robot/enable: std_srvs/srv/SetBool\n"
        "  Service Clients:\n\n  Action Servers:\n\n  Action Clients:\n\n",
        "",
    )
    assert answers["relative"] == answers["info"] == answers["hidden"]


def test_an_unknown_node_is_an_error_that_names_the_nearest(answers):
    assert answers["unknown"] == (1, "", "Unable to find node '/robot/drivr'; did you mean '/robot/driver'?\n")


def test_nodes_that_share_a_name_are_counted_and_told(ros2, robot, ros_domain):
    import rclpy

    context = rclpy.Context()
    rclpy.init(context=context, domain_id=ros_domain)
    twin = rclpy.create_node("driver", namespace="/robot", context=context)
    try:
        code, text, errors = ros2("node", "list")
    finally:
        twin.destroy_node()
        context.try_shutdown()
    assert (code, text.split().count("/robot/driver")) == (0, 2)
    assert "nodes in the graph that share an exact name" in errors


def test_a_node_that_ends_while_it_is_looked_at_is_one_sentence(robot, ros_domain, monkeypatch):
    import argparse

    from gz_course.sim.ros.ros2.command.node import info
    from gz_course.sim.ros.ros2.errors import CommandError
    from gz_course.sim.ros.ros2.graph import destroy_ended

    monkeypatch.setenv("ROS_DOMAIN_ID", str(ros_domain))
    monkeypatch.setattr(info, "find_node", lambda *_: "/gone")
    with pytest.raises(CommandError, match="The node '/gone' ended while it was looked at"):
        info.main(argparse.Namespace(spin_time=None, use_sim_time=False, node_name="/gone", include_hidden=False))
    destroy_ended()
