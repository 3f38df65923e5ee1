import pytest

from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import Node

CALL = ("--reqtype", "gz.msgs.StringMsg", "--reptype", "gz.msgs.StringMsg")


@pytest.fixture
def node(partition):
    with Node() as each:
        yield each


@pytest.fixture
def shout(node):
    def answer(request):
        return request.data != "fail", StringMsg(data=request.data.upper())

    node.advertise_service("/shout", StringMsg, StringMsg, answer)


def test_list_names_services_sorted(gz, node, shout):
    node.advertise_service("/a", Empty, Boolean, lambda _: Boolean())
    assert gz("service", "-l").end() == (0, "/a\n/shout\n", "")


def test_info_names_addresses_and_types(gz, node, shout):
    address = node.service_info("/shout")[0].addr
    assert gz("service", "-i", "-s", "/shout").end() == (
        0,
        "Service providers [Address, Request Message Type, Response Message Type]:\n"
        f"  {address}, gz.msgs.StringMsg, gz.msgs.StringMsg\n",
        "",
    )


def test_info_on_an_unknown_service_names_the_nearest(gz, shout):
    code, out, error = gz("service", "-i", "-s", "/shoot").end()
    assert (code, out) == (0, "No service providers on service [/shoot]\n")
    assert error == "gz service: there is no service [/shoot]; did you mean '/shout'?\n"


def test_a_call_prints_the_response(gz, shout):
    assert gz("service", "-s", "/shout", *CALL, "-r", 'data: "hey"').end() == (0, 'data: "HEY"\n\n', "")


def test_without_a_request_type_there_are_no_arguments(gz, node):
    node.advertise_service("/ready", Empty, Boolean, lambda _: Boolean(data=True))
    assert gz("service", "-s", "/ready", "--reptype", "gz.msgs.Boolean", "-r").end() == (0, "data: true\n\n", "")


def test_without_a_response_type_the_call_is_one_way(gz, node, inbox):
    node.advertise_service("/tell", StringMsg, Empty, inbox)
    assert gz("service", "-s", "/tell", "--reqtype", "gz.msgs.StringMsg", "-r", 'data: "x"').end() == (0, "", "")
    assert inbox.take() == [StringMsg(data="x")]


def test_a_provider_that_fails(gz, shout):
    code, out, _ = gz("service", "-s", "/shout", *CALL, "-r", 'data: "fail"').end()
    assert (code, out) == (0, "Service call failed\n")


@pytest.mark.parametrize(
    ("service", "request_type", "words"),
    [
        ("/shoot", "gz.msgs.StringMsg", "there is no service [/shoot]; did you mean '/shout'?"),
        ("/shout", "gz.msgs.Boolean", "[/shout] takes gz.msgs.StringMsg and answers with gz.msgs.StringMsg; the call"),
    ],
)
def test_a_call_nobody_answers_says_why(gz, shout, service, request_type, words):
    call = ("--reqtype", request_type, "--reptype", "gz.msgs.StringMsg", "--timeout", "100")
    code, out, error = gz("service", "-s", service, *call, "-r", "").end()
    assert (code, out, error.count("\n")) == (0, "", 1)
    assert error.startswith(f"Service call timed out: {words}")


def test_a_provider_that_is_too_slow(gz, node):
    import threading

    go_on = threading.Event()
    node.advertise_service("/slow", Empty, Boolean, lambda _: go_on.wait(120) and Boolean())
    call = gz("service", "-s", "/slow", "--reptype", "gz.msgs.Boolean", "--timeout", "200", "-r")
    code, _, error = call.end()
    go_on.set()
    assert code == 0
    assert error == "Service call timed out: [/slow] did not answer within 200 ms; a longer --timeout may help.\n"


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["-i"], 107, "--info requires --service"),
        (["-r", ""], 107, "--req requires --service"),
        (["-l", "-i", "-s", "/a"], 108, "--list excludes --info"),
        (["--lits"], 109, "did you mean '--list'?"),
        (["-s", "/a", "-r", "", "--timeout", "soon"], 104, "'soon'"),
        (["-s", "/a", "-r", "", "--reqtype", "gz.msgs.Bolean"], 1, "did you mean 'gz.msgs.Boolean"),
        (["-s", "/a", "-r", "", "--reptype", "gz.msgs.Bolean"], 1, "did you mean 'gz.msgs.Boolean"),
        (["-s", "/a", "-r", "dta: 1", "--reqtype", "gz.msgs.Boolean"], 1, "did you mean 'data'?"),
        (["-s", "/a//b", "-r"], 1, "must not contain '//'"),
    ],
)
def test_wrong_usage_is_one_line_and_a_code(capsys, arguments, code, words):
    from gz_course.sim.gz.command import main

    try:
        result = main(["service", *arguments])
    except SystemExit as end:
        result = end.code
    out, error = capsys.readouterr()
    assert (result, out, error.count("\n")) == (code, "", 1)
    assert error.startswith("gz service: ")
    assert words in error
