"""`ros2 service` against running services."""

import os
import signal

import pytest

SILENT = "/robot/silent"
LOOKED_UP = {
    "list": ["list"],
    "types": ["list", "-t"],
    "count": ["list", "-c"],
    "type": ["type", "/robot/enable"],
    "type unknown": ["type", "/robot/enabel"],
    "find": ["find", "std_srvs/srv/SetBool"],
    "find count": ["find", "-c", "std_srvs/SetBool"],
    "find nothing": ["find", "std_srvs/srv/Empty"],
    "find unknown": ["find", "std_srvs/srv/SetBol"],
    "info": ["info", "/robot/enable"],
    "info unknown": ["info", "/robot/enabel"],
}
CALLED = {
    "call": ["call", "/robot/enable", "std_srvs/srv/SetBool", "data: yes"],
    "short type": ["call", "robot/enable", "std_srvs/SetBool", "--qos-depth", "3"],
    "wrong field": ["call", "/robot/enable", "std_srvs/srv/SetBool", "{dta: true}"],
    "not yaml": ["call", "/robot/enable", "std_srvs/srv/SetBool", "{data: "],
    "wrong type": ["call", "/robot/enable", "std_srvs/srv/Trigger"],
    "no type": ["call", "/robot/enable", "std_srvs/srv/Triger"],
    "bad name": ["call", "/a b", "std_srvs/srv/Trigger"],
    "unknown": ["call", "/robot/enabl", "std_srvs/srv/Trigger", "--timeout", "0.2"],
    "silent": ["call", SILENT, "std_srvs/srv/Trigger", "--timeout", "0.3"],
}


@pytest.fixture(scope="module")
def answers(robot, run_together):
    results = {}
    # One after the other: a client makes a name known, and a second type of it.
    for asked in (LOOKED_UP, CALLED):
        answers = run_together(*(["service", *words] for words in asked.values()))
        results.update(zip(asked, answers, strict=True))
    return results


def test_list(answers):
    code, text, errors = answers["list"]
    names = text.split()
    assert (code, errors) == (0, "")
    assert names == sorted(names)
    assert {"/robot/enable", "/robot/driver/list_parameters"} <= set(names)
    assert "/robot/enable [std_srvs/srv/SetBool]" in answers["types"][1].splitlines()
    assert answers["count"] == (0, f"{len(names)}\n", "")


def test_type_find_and_info(answers):
    assert answers["type"] == (0, "std_srvs/srv/SetBool\n", "")
    assert answers["find"] == (0, "/robot/enable\n", "")
    assert answers["find count"] == (0, "1\n", "")
    assert answers["find nothing"] == (0, "", "")
    assert answers["info"] == (0, "Type: std_srvs/srv/SetBool\nClients count: 0\nServices count: 1\n", "")


def test_call_prints_request_and_response(answers):
    assert answers["call"] == (
        0,
        "requester: making request: std_srvs.srv.SetBool_Request(data=True)\n\n"
        "response:\nstd_srvs.srv.SetBool_Response(success=True, message='as you wish')\n\n",
        "",
    )
    assert "SetBool_Response(success=False" in answers["short type"][1]


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        ("type unknown", "Unknown service '/robot/enabel'; did you mean '/robot/enable'?"),
        ("info unknown", "Unknown service '/robot/enabel'; did you mean '/robot/enable'?"),
        ("find unknown", "The service type 'std_srvs/srv/SetBol' is invalid; did you mean 'std_srvs/srv/SetBool'?"),
        ("wrong field", "Failed to populate field: SetBool_Request has no field 'dta', its fields: data; did you mean"),
        ("not yaml", "The passed value is not YAML: line "),
        ("wrong type", "The service /robot/enable has the type std_srvs/srv/SetBool, not std_srvs/srv/Trigger"),
        ("no type", "The service type 'std_srvs/srv/Triger' is invalid; did you mean 'std_srvs/srv/Trigger'?"),
        ("bad name", "'/a b' is not a service name: "),
        ("unknown", "The service /robot/enabl is not available; did you mean '/robot/enable'?"),
        ("silent", "The service /robot/silent has not answered within 0.3 s"),
    ],
)
def test_what_is_wrong_is_one_sentence(answers, asked, sentence):
    code, _, errors = answers[asked]
    assert code == 1
    assert errors.startswith(sentence)
    assert len(errors.splitlines()) == 1


def test_a_client_that_ends_before_its_answer_ends_no_server(robot, ros2):
    """rclpy warns then; as an error, the warning would end the thread of the server."""
    import rclpy
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from std_srvs.srv import SetBool

    deaf = rclpy.create_node("deaf", context=robot.context)
    # What answers is volatile, so DDS does not connect it with this client.
    client = deaf.create_client(
        SetBool, "/robot/enable", qos_profile=QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    )
    client.call_async(SetBool.Request())
    answer = ros2("service", "call", "/robot/enable", "std_srvs/srv/SetBool", "data: yes")
    deaf.destroy_node()
    assert (answer[0], answer[2]) == (0, "")


def test_call_repeats_until_interrupted(start, robot):
    command = start(
        "service", "call", "-r", "50", "/robot/enable", "std_srvs/srv/SetBool", "--stdin", stdin_text="data: true"
    )
    command.wait_for("success=True", times=3)
    os.kill(command.process.pid, signal.SIGINT)
    code, _, errors = command.wait()
    assert (code, errors) == (2, "")


def test_an_interrupt_ends_a_call_that_waits(start, robot):
    command = start("service", "call", SILENT, "std_srvs/srv/Trigger")
    command.wait_for("making request")
    os.kill(command.process.pid, signal.SIGINT)
    code, _, errors = command.wait()
    assert (code, errors) == (2, "")
