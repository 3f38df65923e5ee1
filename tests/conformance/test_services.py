"""Services: ours, called by the real client; there is no real provider to call."""

import pytest

STRING = "ignition.msgs.StringMsg"
CALL = ("--reqtype", STRING, "--reptype", STRING, "--timeout", "60000")


@pytest.fixture
def ours(stage):
    """A participant of ours that offers /shout."""
    participant = stage.participant()
    assert participant.ask("serve for fortress", "/shout", "gz.msgs.StringMsg", "gz.msgs.StringMsg")
    return participant


def test_both_list_our_service(stage, ours, until):
    for start in (lambda: stage.real_service("-l"), lambda: stage.gz("service", "-l")):
        code, out, _ = until(start, lambda out: "/shout" in out)
        assert (code, out) == (0, "/shout\n")


def test_both_say_the_same_about_our_service(stage, ours, until):
    arguments = ("-i", "-s", "/shout")
    _, real, _ = until(lambda: stage.real_service(*arguments), lambda out: "tcp" in out)
    code, own, _ = until(lambda: stage.gz("service", *arguments), lambda out: "tcp" in out)
    assert (code, own) == (0, real)
    assert f", {STRING}, {STRING}\n" in real


def test_both_say_the_same_about_a_service_that_there_is_not(stage):
    real, own = stage.real_service("-i", "-s", "/nowhere"), stage.gz("service", "-i", "-s", "/nowhere")
    assert (real.wait(), own.wait()) == (0, 0)
    assert own.out == real.out


@pytest.mark.proof  # beside much load the real client may miss the answer
def test_both_calls_are_answered_with_the_same_text(stage, ours):
    request = ("-s", "/shout", *CALL, "-r", 'header: {stamp: {sec: 3}}, data: "hey"')
    real, own = stage.real_service(*request), stage.gz("service", *request)
    assert (real.wait(), own.wait()) == (0, 0)
    assert real.out == 'header {\n  stamp {\n    sec: 3\n  }\n}\ndata: "HEY"\n\n'
    assert own.out == real.out


def test_both_say_that_a_call_failed(stage, ours):
    request = ("-s", "/shout", *CALL, "-r", 'data: "fail"')
    real, own = stage.real_service(*request), stage.gz("service", *request)
    assert (real.wait(), own.wait()) == (0, 0)
    assert own.out == real.out == "Service call failed\n"


def test_both_time_out_on_other_types(stage, ours):
    call = ("--reqtype", "ignition.msgs.Twist", "--reptype", STRING, "--timeout", "300")
    request = ("-s", "/shout", *call, "-r", "")
    real, own = stage.real_service(*request), stage.gz("service", *request)
    assert (real.wait(), own.wait()) == (0, 0)
    assert real.error.startswith("Service call timed out")
    assert own.error.startswith("Service call timed out: [/shout] takes gz.msgs.StringMsg")


def test_a_real_one_way_call_arrives(stage):
    participant = stage.participant()
    participant.ask("serve one-way", "/tell", STRING, "ignition.msgs.Empty")
    call = ("--reqtype", STRING, "--reptype", "ignition.msgs.Empty", "--timeout", "1000")
    assert stage.real_service("-s", "/tell", *call, "-r", 'data: "this"').wait() == 0
    assert participant.heard.get(timeout=600) == ["", "", "this"]
