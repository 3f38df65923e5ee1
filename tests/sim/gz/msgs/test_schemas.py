"""Every message type against `schemas.txt`, the table of the fields and values of gz-msgs 10: names, numbers, types.

A line is one type: `NAME: field=number:type ...`, with `*` before the type of a repeated field; `(a b)` is a oneof and
`{NAME VALUE=number ...}` an enum inside the message. A type that is added or changed on purpose changes its line too.

Source: https://gazebosim.org/api/msgs/10/, for DVL messages https://gazebosim.org/api/msgs/9/
"""

from pathlib import Path

from google.protobuf.descriptor import FieldDescriptor

from gz_course.sim.gz.msgs import message_class, type_names
from gz_course.sim.gz.msgs.proto_reader import SCALARS

TABLE = Path(__file__).with_name("schemas.txt")
KINDS = {number: name for name, number in SCALARS.items()}


def kind(field: FieldDescriptor) -> str:
    described = field.message_type or field.enum_type
    if described is None:
        return KINDS[field.type]
    if field.message_type is not None and field.message_type.GetOptions().map_entry:
        entry = field.message_type.fields_by_name
        return f"map<{kind(entry['key'])},{kind(entry['value'])}>"
    return described.full_name.removeprefix("gz.msgs.")


def line(descriptor) -> str:
    words = []
    for field in descriptor.fields:
        is_map = field.message_type is not None and field.message_type.GetOptions().map_entry
        words.append(f"{field.name}={field.number}:{'*' if field.is_repeated and not is_map else ''}{kind(field)}")
    words += [f"({' '.join(each.name for each in oneof.fields)})" for oneof in descriptor.oneofs]
    for enum in descriptor.enum_types:
        words.append(f"{{{enum.name} {' '.join(f'{each.name}={each.number}' for each in enum.values)}}}")
    return f"{descriptor.full_name.removeprefix('gz.msgs.')}: {' '.join(words)}"


def lines() -> list[str]:
    found: dict[str, str] = {}

    def add(descriptor) -> None:
        found[descriptor.full_name] = line(descriptor)
        for nested in descriptor.nested_types:
            if not nested.GetOptions().map_entry:
                add(nested)
        for enum in descriptor.file.enum_types_by_name.values():
            values = " ".join(f"{each.name}={each.number}" for each in enum.values)
            found[enum.full_name] = f"{enum.full_name.removeprefix('gz.msgs.')}: {{{values}}}"

    for name in type_names():
        add(message_class(name).DESCRIPTOR)
    return [found[name] for name in sorted(found)]


def test_every_type_is_that_of_gazebo():
    wanted = TABLE.read_text().splitlines()
    ours = lines()
    assert [each for each in ours if each not in set(wanted)] == []
    assert [each for each in wanted if each not in set(ours)] == []
