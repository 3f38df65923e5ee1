"""A table of topics: what is read, that every fault names its line, and that no text does harm."""

import time

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.kinds.table import COLUMNS, LONGEST, TableError, fault, read

VALUES = st.text(st.characters(codec="ascii", categories=("L", "N", "P")), min_size=1, max_size=30)
TABLES = st.lists(st.dictionaries(st.sampled_from(COLUMNS), VALUES, min_size=1), min_size=1, max_size=8)


@given(TABLES, st.booleans())
def test_what_is_written_is_read(rows, flow):
    text = yaml.safe_dump(rows, default_flow_style=flow, allow_unicode=True, width=1000)
    found = read("topics.yaml", text.encode())
    assert [{k: v for k, v in row.items() if k != "line" and v} for row in found] == rows
    assert all(set(row) == {"line", *COLUMNS} for row in found)


@given(st.binary(max_size=300))
def test_any_bytes_are_read_or_refused_in_one_line(data):
    sentence = fault("topics.yaml", data)
    assert sentence is None or (sentence.startswith("topics.yaml, line ") and "\n" not in sentence)


def test_a_row_knows_its_line_and_what_is_not_filled_in_is_empty():
    text = b"# a comment\n- ros_topic: /a\n  ros_type:\n\n- {ros_topic: /b, direction: ~}\n"
    first, second = read("topics.yaml", text)
    assert (first["line"], first["ros_topic"], first["ros_type"]) == (2, "/a", "")
    assert (second["line"], second["ros_topic"], second["direction"]) == (5, "/b", "")


def test_words_that_yaml_takes_for_something_else_stay_words():
    (row,) = read("topics.yaml", b"- {ros_topic: 0x10, ros_type: no, publisher: 1.50, gz_topic: 2026-11-21}")
    assert [row[c] for c in ("ros_topic", "ros_type", "publisher", "gz_topic")] == ["0x10", "no", "1.50", "2026-11-21"]


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (b"", 1, ["the table is empty"]),
        (b"# only a comment\n", 1, ["the table is empty"]),
        (b"ros_topic: /a\n", 1, ["expected a list of rows"]),
        (b"- /a\n", 1, ["expected a row"]),
        (b"- ros_topic: /a\n  gz_tpye: x\n", 2, ["no column 'gz_tpye'", "did you mean 'gz_type'?"]),
        (b"- ROS_topic: /a\n", 1, ["no column 'ROS_topic'", "did you mean 'ros_topic'?"]),
        (b"- ros_topic: /a\n  ros_type: x\n  ros_type: y\n", 3, ["ros_type appears twice", "line 2"]),
        (
            b"- ros_topic: /a\n  ros_type: x\n  ros_topic: /b\n  ros_type: y\n",
            3,
            ["ros_topic appears twice", "a dash is missing here, '- ros_topic:' begins the next row"],
        ),
        (b"- ros_topic: /a\n  publisher: [a, b]\n", 2, ["publisher must be one value"]),
        (b"- ros_topic: /a\n  publisher: {a: b}\n", 2, ["publisher must be one value"]),
        (b"- ? [a, b]\n  : c\n", 1, ["no column"]),
        (b"- ros_topic: /a\n\tros_type: x\n", 2, ["not valid YAML", "never with tabs"]),
        (b"- ros_topic: '/a\n  ros_type: x\n", 1, ["not valid YAML", "a quotation mark that opens here"]),
        (b"- ros_topic: /a\n  ros_type:x/msg/Y\n  gz_topic: /a\n", 2, ["a space is missing after the colon"]),
        (b"- ros_topic: /a\n  gz_topic:/a\n  gz_type: b\n", 2, ["a space is missing after the colon"]),
        (b"ros_topic,ros_type\n/a,b/msg/C\n", 1, ["Commas separate nothing"]),
        (b"- ros_topic: \xff\n", 1, ["not a YAML text", "byte 0xff is not UTF-8"]),
        (b"- ros_topic: " + b"x" * (LONGEST + 1), 1, ["characters; no name is longer"]),
        (b"- {ros_topic: /a}\n" * 201, 1, ["201 rows"]),
        (b"#" * (64 * 1024 + 1), 1, ["bytes"]),
    ],
)
def test_a_fault_names_its_line(text, line, words):
    with pytest.raises(TableError) as caught:
        read("topics.yaml", text)
    assert caught.value.line == line
    assert [word for word in words if word not in caught.value.sentence] == []
    assert fault("topics.yaml", text).startswith(f"topics.yaml, line {line}: ")


def test_aliases_that_multiply_do_no_harm():
    lines = ["- &a0 {ros_topic: /a}"] + [f"- &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 40)]
    started = time.thread_time()
    assert "expected a row" in fault("topics.yaml", "\n".join(lines).encode())
    assert time.thread_time() - started < 2.0
