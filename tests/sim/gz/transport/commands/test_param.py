"""`gz param` with a registry of this test, in this process."""

import pytest

from gz_course.sim.gz.command import main
from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.parameter_declarations_pb2 import ParameterDeclarations
from gz_course.sim.gz.msgs.parameter_error_pb2 import ParameterError
from gz_course.sim.gz.msgs.parameter_name_pb2 import ParameterName
from gz_course.sim.gz.msgs.parameter_pb2 import Parameter
from gz_course.sim.gz.msgs.parameter_value_pb2 import ParameterValue
from gz_course.sim.gz.transport import Node


@pytest.fixture
def registry():
    """A registry with one parameter, as a server of Gazebo has it."""
    speed = Double(data=0.5)

    def declared(_):
        found = ParameterDeclarations()
        found.parameter_declarations.add(name="speed", type="gz.msgs.Double")
        return found

    def get(request):
        response = ParameterValue()
        response.data.Pack(speed)
        return request.name == "speed", response

    def put(request):
        if request.name != "speed":
            return ParameterError(data=ParameterError.NOT_DECLARED)
        if not request.value.Unpack(speed):
            return ParameterError(data=ParameterError.INVALID_TYPE)
        return ParameterError(data=ParameterError.SUCCESS)

    with Node() as node:
        node.advertise_service("/robot/list_parameters", Empty, ParameterDeclarations, declared)
        node.advertise_service("/robot/get_parameter", ParameterName, ParameterValue, get)
        node.advertise_service("/robot/set_parameter", Parameter, ParameterError, put)
        yield


@pytest.mark.usefixtures("registry")
def test_list_get_and_set(capsys):
    assert main(["param", "-r", "/robot", "-l"]) == 0
    assert "speed            [gz.msgs.Double]\n" in capsys.readouterr().out
    assert main(["param", "-r", "/robot/", "-s", "-n", "speed", "-t", "gz.msgs.Double", "-m", "data: 0.75"]) == 0
    assert "Parameter successfully set!" in capsys.readouterr().out
    assert main(["param", "-r", "/robot", "-g", "-n", "speed"]) == 0
    out = capsys.readouterr().out
    assert "Parameter type [gz.msgs.Double]" in out
    assert "\ndata: 0.75\n-" in out


@pytest.mark.usefixtures("registry")
def test_what_does_not_fit(capsys, monkeypatch):
    from gz_course.sim.gz.transport.commands import param

    setting = ["param", "-r", "/robot", "-s", "-n"]
    for arguments, sentence in (
        (["param", "-r", "/robot", "-g", "-n", "sped"], "did you mean 'speed'"),
        ([*setting, "sped", "-t", "gz.msgs.Double", "-m", "data: 1"], "has no parameter [sped]"),
        ([*setting, "speed", "-t", "gz.msgs.Int32", "-m", "data: 1"], "it is a gz.msgs.Double"),
        ([*setting, "speed", "-t", "gz.msgs.Double", "-m", "date: 1"], "data"),
    ):
        assert main(arguments) == 1
        assert sentence in capsys.readouterr().err
    monkeypatch.setattr(param, "_TIMEOUT_MS", 50)
    assert main(["param", "-r", "/robbot", "-l"]) == 1
    assert "there is no registry [/robbot]; did you mean '/robot'" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["param", "-l"])
