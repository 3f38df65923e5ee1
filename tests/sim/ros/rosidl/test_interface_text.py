"""What is wrong in a text is said in one sentence, with file and line."""

import pytest

from gz_course.sim.ros.rosidl.errors import InvalidInterfaceError
from gz_course.sim.ros.rosidl.interface_text import parse_interface


def sentence(text, kind="msg", name="Thing", package="some_msgs"):
    with pytest.raises(InvalidInterfaceError) as error:
        parse_interface(text, package, kind, name, f"{name}.{kind}")
    return str(error.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("int32 a\nflot32 b", "Thing.msg:2: unknown type 'flot32'; did you mean 'float32'?"),
        ("# comment\n\nint32", "Thing.msg:3: expected a type and a name, found only 'int32'"),
        ("int32 Name", "Thing.msg:1: 'Name' cannot be the name of a field; expected small letters, "),
        ("int32 a__b", "Thing.msg:1: 'a__b' cannot be the name of a field"),
        ("int32 class", "Thing.msg:1: 'class' is a reserved word and cannot be the name of a field"),
        ("int32 check_fields", "'check_fields' is a reserved word"),
        ("int32 a\nint8 b\nstring a", "Thing.msg:3: the name 'a' is already used in line 1"),
        ("int32 A=1\nint32 A=2", "Thing.msg:2: the name 'A' is already used in line 1"),
        ("int8 a 200", "Thing.msg:1: value '200' can not be converted to type 'int8': must be a valid integer"),
        ("bool a maybe", "Thing.msg:1: value 'maybe' can not be converted to type 'bool': must be either"),
        ("int8[2] a [1]", "array must have exactly 2 elements, not 1"),
        ("int8[] a 1", "array value must start with '[' and end with ']'"),
        ("string<=2 a abc", "string must not exceed the maximum length of 2 characters"),
        ("int8 NUMBER=", "Thing.msg:1: expected the value of the constant NUMBER after '='"),
        ("int8 number=1", "'number' cannot be the name of a constant; expected capitals"),
        ("Other X=1", "Thing.msg:1: a constant has one of the types int8, int16,"),
        ("int8[x] a", "Thing.msg:1: 'int8[x]' is not a type; expected a plain type, Name or package/Name"),
        ("int8[-1] a", "'int8[-1]' is not a type"),
        ("string<=0 a", "'string<=0' is not a type"),
        ("a/b/c d", "'a/b/c' is not a type"),
        ("some_msgs/msg/Thing[] d", "'some_msgs/msg/Thing[]' is not a type: write some_msgs/Thing[], without"),
        ("int8 d[]", "Thing.msg:1: the brackets of an array belong to its type: int8[] d"),
        ("speed: float64", "'speed:' is not a type: the type comes first, then the name"),
        ("Some/Thing d", "'Some/Thing' is not a type"),
        ("some_msgs/Thing d 5", "Thing.msg:1: a field of type 'some_msgs/Thing' has no default value, found '5'"),
    ],
)  # fmt: skip
def test_a_wrong_line(text, said):
    assert said in sentence(text)


def test_parts_of_services_and_actions():
    expected = "Thing.srv: expected request and response, separated by one line '---', found 0 of these lines"
    assert sentence("int8 a", "srv") == expected
    assert "goal, result and feedback, separated by two lines '---', found 1" in sentence("---", "action")
    assert sentence("int8 a\n---\nint8 b\nint9 c", "srv").startswith("Thing.srv:4: unknown type 'int9'")


def test_names_of_packages_and_interfaces():
    assert "'thing' cannot be the name of an interface" in sentence("", name="thing")
    assert "'Bad' cannot be the name of a package" in sentence("", package="Bad")


@pytest.mark.parametrize(
    ("texts", "said"),
    [
        ({"A": "B b", "Bee": ""}, "A.msg:1: unknown type PACKAGE/B; PACKAGE has: A, Bee"),
        ({"A": "int8 x\nBea[] b", "Bee": ""}, "A.msg:2: unknown type PACKAGE/Bea; did you mean 'Bee'?"),
        ({"A": "geometry_msg/Pose p"}, "A.msg:1: unknown package 'geometry_msg' in the type geometry_msg/Pose;"),
        ({"A": "geometry_msgs/Posse p"}, "A.msg:1: unknown type geometry_msgs/Posse; did you mean 'Pose'?"),
        ({"A": "int8 x\nA a"}, "A.msg:2: a message cannot contain itself: A contains A"),
        ({"A": "B b", "B": "C[] c", "C": "B[<=2] b"}, "B.msg:1: a message cannot contain itself: B contains C "),
        ({"A": "B b", "B": "int x"}, "B.msg:1: unknown type 'int'"),
    ],
)  # fmt: skip
def test_types_that_do_not_fit_together(packages, texts, said):
    (module,) = packages.load({f"msg/{name}.msg": text for name, text in texts.items()})
    with pytest.raises(InvalidInterfaceError) as error:
        module.A  # noqa: B018
    assert said.replace("PACKAGE", module.__name__.partition(".")[0]) in str(error.value)


def test_a_file_that_is_no_text(packages):
    package = packages.write({"msg/A.msg": ""})
    (packages.prefix / "share" / package / "msg" / "A.msg").write_bytes(b"int8 a # \xff")
    with pytest.raises(ImportError, match=r"A\.msg: this is not a text in UTF-8"):
        exec(f"from {package}.msg import A")


def test_constants_and_defaults(packages):
    from gz_course.tests.sim.ros.rosidl import every_kind

    (module, *_) = packages.load(every_kind.TEXTS)
    constants, defaults = module.Constants, module.Defaults()
    assert (constants.YES, constants.B, constants.C, constants.F) == (True, b"\7", 65, -1.5)
    assert (constants.LONG, constants.HEX, constants.WIDE) == (-(2**63), 31, "ü")
    assert (constants.TEXT, constants.QUOTED) == ("a text, with 'quotes'", " spaces ")
    assert (defaults.yes, defaults.b, defaults.f, defaults.i) == (True, b"\7", 1e-9, -5)
    assert (defaults.s, defaults.t, defaults.w) == ("a b", "abc", "ü")
    assert defaults.fa.tolist() == [1.5, -2.0] and defaults.fs.tolist() == [1.0, 2.0, 3.0]
    assert (defaults.ba, defaults.ya, defaults.ss) == ([True, False], [b"\1", b"\2"], ["a, b", "c"])
    assert module.Defaults.S__DEFAULT == "a b"
    defaults.fs.append(4.0)
    assert module.Defaults().fs.tolist() == [1.0, 2.0, 3.0]
