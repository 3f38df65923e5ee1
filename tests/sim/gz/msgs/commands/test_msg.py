import pytest

from gz_course.sim.gz.command import main
from gz_course.sim.gz.msgs import type_names


def test_list_names_every_type(capsys):
    assert main(["msg", "-l"]) == 0
    assert capsys.readouterr().out.splitlines() == type_names()


@pytest.mark.parametrize("spelling", ["gz.msgs.Twist", "gz_msgs.Twist", ".gz.msgs.Twist", "Twist"])
def test_info_prints_name_file_and_definition(capsys, spelling):
    assert main(["msg", "--info", spelling]) == 0
    assert capsys.readouterr().out == (
        "Name: gz.msgs.Twist\n"
        "File: gz/msgs/twist.proto\n"
        "\n"
        "message Twist {\n"
        "  .gz.msgs.Header header = 1;\n"
        "  .gz.msgs.Vector3d linear = 2;\n"
        "  .gz.msgs.Vector3d angular = 3;\n"
        "}\n"
        "\n"
    )


def test_info_takes_several_types(capsys):
    assert main(["msg", "-i", "gz.msgs.Time", "gz.msgs.Any"]) == 0
    names = [line for line in capsys.readouterr().out.splitlines() if line.startswith("Name")]
    assert names == ["Name: gz.msgs.Time", "Name: gz.msgs.Any"]


def test_an_unknown_type_is_one_line_with_the_nearest_name(capsys):
    assert main(["msg", "-i", "gz.msgs.Twits"]) == 1
    out, error = capsys.readouterr()
    assert out == ""
    assert error == "gz msg: There is no message type 'gz.msgs.Twits' in gz.msgs; did you mean 'gz.msgs.Twist'?\n"


def test_the_version_is_one_line(capsys):
    with pytest.raises(SystemExit) as end:
        main(["msg", "-v"])
    assert not end.value.code
    assert capsys.readouterr().out.count(".") == 2
