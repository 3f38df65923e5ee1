"""The language of a CMakeLists.txt."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.ros.ament_cmake.cmake_text import commands_of, values_of
from gz_course.sim.ros.ament_cmake.errors import PackageError

VARIABLES = {"NAME": "robot", "MSGS": "msg/A.msg;msg/B.msg", "INNER": "NAME", "EMPTY": "", "WILD": r"a\b;${NAME}"}


def values(text):
    (command,) = commands_of(f"f({text})", "CMakeLists.txt")
    return values_of(command.arguments, lambda name, kind: VARIABLES.get(name, "") if not kind else f"<{kind} {name}>")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a b\n\tc", ["a", "b", "c"]),
        ('"a b" c', ["a b", "c"]),
        ("${MSGS} end", ["msg/A.msg", "msg/B.msg", "end"]),
        ('"${MSGS}"', ["msg/A.msg;msg/B.msg"]),
        ("${EMPTY}", []),
        ('"${EMPTY}"', [""]),
        ("share/${NAME}/x", ["share/robot/x"]),
        ("${${INNER}}", ["robot"]),
        (r"\${NAME}", ["${NAME}"]),
        (r'"say \"hi\"\n"', ['say "hi"\n']),
        (r"a\ b;c", ["a b", "c"]),
        ("[[${NAME} ; )]]", ["${NAME} ; )"]),
        ("[=[\na]]b]=]", ["a]]b"]),
        ("a # to the end )\n b", ["a", "b"]),
        ("a #[[ over\n lines ) ]] b", ["a", "b"]),
        ("NOT (A AND B)", ["NOT", "(", "A", "AND", "B", ")"]),
        ("$ENV{HOME}", ["<ENV HOME>"]),
        ('"a\\\nb"', ["ab"]),
        ("${WILD}", [r"a\b", "${NAME}"]),
        ('-DX="a b"', ['-DX="a b"']),
        ("$<INSTALL_INTERFACE:include>", ["$<INSTALL_INTERFACE:include>"]),
    ],
)
def test_the_values_of_arguments(text, expected):
    assert values(text) == expected


def test_commands_know_their_line_and_no_case():
    text = "# a comment\nPROJECT(x)\n\n#[[ two\nlines ]] Set (\nA b)\n"
    found = [(command.name, command.line) for command in commands_of(text, "CMakeLists.txt")]
    assert found == [("project", 2), ("set", 5)]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("project(x)\nset(A\nb", "CMakeLists.txt:2: the parenthesis of 'set(' is never closed; expected ')'"),
        ('a()\nset(A "b)\n', "CMakeLists.txt:2: this text is never closed; expected another '\"', in 'set('"),
        ("a()\n)", "CMakeLists.txt:2: expected the name of a command, found ')'"),
        ("project x", "CMakeLists.txt:1: expected '(' after the name of the command 'project'"),
    ],
)
def test_a_syntax_error_has_file_and_line(text, sentence):
    with pytest.raises(PackageError) as error:
        commands_of(text, "CMakeLists.txt")
    assert str(error.value) == sentence


@given(st.lists(st.text(st.characters(codec="utf-8", exclude_characters="\0\1\r"), max_size=20), max_size=5))
def test_whatever_is_quoted_comes_back(texts):
    escaped = [text.replace("\\", "\\\\").replace('"', '\\"').replace("$", "\\$") for text in texts]
    assert values(" ".join(f'"{text}"' for text in escaped)) == texts


@given(st.text(alphabet='ab(){}[]=#"\\$;\n ${NAME}', max_size=60))
def test_any_text_is_read_or_refused_with_a_line(text):
    try:
        for command in commands_of(text, "CMakeLists.txt"):
            values_of(command.arguments, lambda name, kind: VARIABLES.get(name, ""))
    except PackageError as error:
        assert str(error).startswith("CMakeLists.txt:")
