import pytest
from google.protobuf.descriptor_pb2 import FieldDescriptorProto
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.msgs.proto_reader import ProtoSyntaxError, read_proto

EXAMPLE = """
// A comment; with { signs } in it
syntax = "proto3"; /* and
another */
package a.b;
option java_package = "x";
import public "other.proto";
enum Colour { option allow_alias = true; RED = 0; DEEP_RED = 0 [deprecated = true]; BLUE = -1; reserved 7; }
message Outer {
  message Inner { string text = 1; }
  enum Kind { NONE = 0; }
  reserved 8, 9;
  repeated double numbers = 1 [packed = true];
  .a.b.Outer.Inner inner = 0x2;
  oneof choice { int32 one = 3; Kind two = 4; }
  map<string, Inner> by_name = 5;
  optional bool flag = 6;
  ;
}
"""


def test_every_construct_is_read():
    file = read_proto(EXAMPLE, "a/b/example.proto")
    assert (file.name, file.package, file.syntax, list(file.dependency)) == (
        "a/b/example.proto",
        "a.b",
        "proto3",
        ["other.proto"],
    )
    (colour,), (outer,) = file.enum_type, file.message_type
    assert [(value.name, value.number) for value in colour.value] == [
        ("RED", 0),
        ("DEEP_RED", 0),
        ("BLUE", -1),
    ]
    fields = {field.name: field for field in outer.field}
    assert [(name, field.number) for name, field in fields.items()] == [
        ("numbers", 1),
        ("inner", 2),
        ("one", 3),
        ("two", 4),
        ("by_name", 5),
        ("flag", 6),
    ]
    assert fields["numbers"].label == FieldDescriptorProto.LABEL_REPEATED
    assert fields["numbers"].type == FieldDescriptorProto.TYPE_DOUBLE
    assert fields["inner"].type_name == ".a.b.Outer.Inner"
    assert [name for name, field in fields.items() if field.HasField("oneof_index")] == ["one", "two"]
    entry = outer.nested_type[1]
    assert (entry.name, entry.options.map_entry, fields["by_name"].type_name) == (
        "ByNameEntry",
        True,
        "ByNameEntry",
    )
    assert [(field.name, field.number) for field in entry.field] == [("key", 1), ("value", 2)]


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ('syntax = "proto2";', 1, "proto2"),
        ("\nmessage A {\n  string = 1;\n}", 3, "a field name"),
        ("message A {\n  string a = x;\n}", 2, "number of field 'a'"),
        ("message A {\n  string a = 1\n}", 3, "';'"),
        ("message A {\n  string a = 1;\n", 2, "field type"),
        ("service A {}", 1, "'service'"),
        ("\n\n  $", 3, "'$'"),
        ("import twist;", 1, "in quotes"),
        ("enum E {\n A = ;\n}", 2, "number of 'A'"),
        ("message A { option x = 1", 1, "closing brace"),
    ],
)
def test_errors_name_the_line_and_what_was_expected(text, line, words):
    with pytest.raises(ProtoSyntaxError) as caught:
        read_proto(text, "x.proto", "folder/x.proto")
    assert str(caught.value).startswith(f"folder/x.proto:{line}: ")
    assert words in str(caught.value)


@given(st.text() | st.lists(st.sampled_from(EXAMPLE.split()), max_size=40).map(" ".join))
def test_any_text_is_read_or_refused(text):
    try:
        read_proto(text, "x.proto")
    except ProtoSyntaxError as error:
        assert str(error).startswith("x.proto:")
