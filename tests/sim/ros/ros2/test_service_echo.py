"""`ros2 service echo` prints the events of services and clients with introspection."""

import argparse
import signal
from types import SimpleNamespace

import pytest
import rclpy
import yaml
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import qos_profile_services_default
from rclpy.service_introspection import ServiceIntrospectionState
from std_srvs.srv import SetBool

from gz_course.sim.ros.ros2.command.service import echo
from gz_course.sim.ros.ros2.command.topic import echo as topic_echo
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.graph import destroy_ended
from gz_course.tests.sim.spinning import spinning


@pytest.fixture
def observed(ros_domain):
    """Return a client of the service /lamp; both ends publish their events. A call is repeated all the time."""
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=ros_domain)
    node = rclpy.create_node("lamp_driver", context=context)

    def switch(request, response):
        response.success, response.message = request.data, "as you wish"
        return response

    service = node.create_service(SetBool, "/lamp", switch)
    client = node.create_client(SetBool, "/lamp")
    for end in (service, client):
        end.configure_introspection(node.get_clock(), qos_profile_services_default, ServiceIntrospectionState.CONTENTS)
    node.create_timer(0.1, lambda: client.service_is_ready() and client.call_async(SetBool.Request(data=True)))
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    with spinning(executor):
        yield node
    node.destroy_node()
    context.try_shutdown()


def test_echo_prints_every_event_with_its_content(observed, start):
    command = start("service", "echo", "lamp")
    for name in ("REQUEST_SENT", "REQUEST_RECEIVED", "RESPONSE_SENT", "RESPONSE_RECEIVED"):
        command.wait_for(f"event_type: {name}")
    command.wait_for("as you wish")
    command.wait_for("---", times=6)
    command.process.send_signal(signal.SIGINT)
    code, text, errors = command.wait()
    assert (code, errors) == (2, "")
    events = list(yaml.safe_load_all(text.rsplit("---", 1)[0]))
    assert list(events[0]) == ["info", "request", "response"]
    assert list(events[0]["info"]) == ["event_type", "stamp", "client_gid", "sequence_number"]
    by_type = {event["info"]["event_type"]: event for event in events}
    assert by_type["REQUEST_SENT"]["request"] == [{"data": True}]
    assert by_type["RESPONSE_SENT"]["response"] == [{"success": True, "message": "as you wish"}]


def test_without_events_echo_says_what_is_missing(robot, start):
    command = start("service", "echo", "/robot/enable", "std_srvs/srv/SetBool")
    command.wait_for("must call configure_introspection(clock", stream="stderr")
    command.process.send_signal(signal.SIGINT)
    assert command.wait()[:2] == (2, "")


def test_an_unknown_service_is_one_sentence(robot, monkeypatch):
    monkeypatch.setenv("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")  # as the command sets it
    parser = argparse.ArgumentParser()
    echo.add_arguments(parser)
    try:
        with pytest.raises(CommandError, match=r"^Could not determine the type .*; did you mean '/robot/enable'\?$"):
            echo.main(parser.parse_args(["/robot/enabel"]))
    finally:
        destroy_ended()


def test_topic_echo_reports_lost_messages(capsys):
    topic_echo._report_lost(SimpleNamespace(total_count_change=2, total_count=5))
    assert capsys.readouterr().out == "A message was lost!!!\n\ttotal count change:2\n\ttotal count: 5---\n"
