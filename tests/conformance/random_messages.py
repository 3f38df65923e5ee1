"""Random messages of a type, with only those fields and enum values that the other side knows too."""

from google.protobuf.descriptor import FieldDescriptor
from hypothesis import strategies

from gz_course.sim.gz.msgs.proto_reader import read_proto

_DEPTH = 2
_BITS = {
    FieldDescriptor.CPPTYPE_INT32: (-(2**31), 2**31 - 1),
    FieldDescriptor.CPPTYPE_INT64: (-(2**63), 2**63 - 1),
    FieldDescriptor.CPPTYPE_UINT32: (0, 2**32 - 1),
    FieldDescriptor.CPPTYPE_UINT64: (0, 2**64 - 1),
}
_DOUBLES = strategies.one_of(strategies.floats(allow_nan=False), strategies.just(float("nan")))
_SINGLES = strategies.one_of(strategies.floats(allow_nan=False, width=32), strategies.just(float("nan")))


class Vocabulary:
    """Which fields and enum values each message type has on the other side."""

    def __init__(self, information):
        """`information`: type name -> the text of `msg --info`."""
        self.fields, self.values = {}, {}
        for name, text in information.items():
            file = read_proto(text.split("\n\n", 1)[1], name)
            self._add(file.message_type[0], name.rpartition(".")[0])

    def _add(self, message, scope):
        name = f"{scope}.{message.name}".replace("ignition.", "gz.")
        self.fields[name] = {(field.name, field.number) for field in message.field}
        for enum in message.enum_type:
            self.values[f"{name}.{enum.name}"] = {value.number for value in enum.value}
        for nested in message.nested_type:
            self._add(nested, name)

    def messages(self, message_class, depth=_DEPTH):
        """A strategy for messages of a type."""
        name = message_class.DESCRIPTOR.full_name.replace("ignition.", "gz.")
        known = [each for each in message_class.DESCRIPTOR.fields if (each.name, each.number) in self.fields[name]]

        @strategies.composite
        def build(draw):
            message = message_class()
            for field in known:
                if draw(strategies.booleans()):
                    self._fill(draw, message, field, depth)
            return message

        return build()

    def _fill(self, draw, message, field, depth):
        entry = field.message_type
        if entry is not None and entry.GetOptions().map_entry:
            target = getattr(message, field.name)
            of = entry.fields_by_name["value"]
            for key in draw(strategies.lists(self._values(entry.fields_by_name["key"]), max_size=3)):
                if of.message_type is None:
                    target[key] = draw(self._values(of))
                elif depth:
                    target[key].CopyFrom(draw(self.messages(type(target[key]), depth - 1)))
        elif entry is not None:
            if not depth or not self._knows(entry):
                return
            if field.is_repeated:
                for _ in range(draw(strategies.integers(0, 2))):
                    added = getattr(message, field.name).add()
                    added.CopyFrom(draw(self.messages(type(added), depth - 1)))
            else:
                target = getattr(message, field.name)
                target.SetInParent()
                target.CopyFrom(draw(self.messages(type(target), depth - 1)))
                target.SetInParent()
        elif field.is_repeated:
            getattr(message, field.name).extend(draw(strategies.lists(self._values(field), max_size=3)))
        else:
            setattr(message, field.name, draw(self._values(field)))

    def _knows(self, descriptor):
        return descriptor.full_name.replace("ignition.", "gz.") in self.fields

    def _values(self, field):
        if field.enum_type is not None:
            numbers = {value.number for value in field.enum_type.values}
            name = field.enum_type.full_name.replace("ignition.", "gz.")
            return strategies.sampled_from(sorted(numbers & self.values.get(name, numbers)))
        if field.cpp_type in _BITS:
            return strategies.integers(*_BITS[field.cpp_type])
        return {
            FieldDescriptor.CPPTYPE_DOUBLE: _DOUBLES,
            FieldDescriptor.CPPTYPE_FLOAT: _SINGLES,
            FieldDescriptor.CPPTYPE_BOOL: strategies.booleans(),
            FieldDescriptor.CPPTYPE_STRING: (
                strategies.binary(max_size=12)
                if field.type == FieldDescriptor.TYPE_BYTES
                else strategies.text(strategies.characters(exclude_categories=["Cs"]), max_size=12)
            ),
        }[field.cpp_type]
