"""Parser of `.proto` texts; protobuf builds message classes from the descriptors it returns.

It reads the part of proto3 that Gazebo's messages use: package, import, message (nested too), enum, oneof, map,
repeated, optional, reserved and field options, which are skipped.

Source: https://protobuf.dev/reference/protobuf/proto3-spec/
"""

from __future__ import annotations

import re

from google.protobuf.descriptor_pb2 import (
    DescriptorProto,
    EnumDescriptorProto,
    FieldDescriptorProto,
    FileDescriptorProto,
)

_TOKEN = re.compile(
    r"""
    (?P<space>[ \t\r\n]+|//[^\n]*|/\*.*?\*/)
    | (?P<word>\.?[A-Za-z_][A-Za-z0-9_.]*)
    | (?P<number>-?(?:0[xX][0-9a-fA-F]+|[0-9]+))
    | (?P<text>"[^"\n]*"|'[^'\n]*')
    | (?P<sign>[{}\[\]()<>=;,])
    """,
    re.VERBOSE | re.DOTALL,
)

SCALARS = {
    name: getattr(FieldDescriptorProto, f"TYPE_{name.upper()}")
    for name in (
        *("double", "float", "int32", "int64", "uint32", "uint64", "sint32", "sint64"),
        *("fixed32", "fixed64", "sfixed32", "sfixed64", "bool", "string", "bytes"),
    )
}


class ProtoSyntaxError(ValueError):
    """A `.proto` text that cannot be parsed; the message has file, line, what was expected and what was found."""


class _Reader:
    """A recursive-descent parser over the tokens of one file."""

    def __init__(self, text: str, path: str) -> None:
        self._path = path
        self._text = text
        self._tokens: list[tuple[str, int]] = []
        position = 0
        while position < len(text):
            match = _TOKEN.match(text, position)
            if match is None:
                raise self._error(f"expected a word, number, string or sign, but found {text[position]!r}", position)
            if match.lastgroup != "space":
                self._tokens.append((match.group(), position))
            position = match.end()
        self._next = 0

    def _error(self, sentence: str, offset: int | None = None) -> ProtoSyntaxError:
        if offset is None:
            at = min(self._next, len(self._tokens) - 1)
            offset = self._tokens[at][1] if self._tokens else 0
        line = self._text.count("\n", 0, offset) + 1
        return ProtoSyntaxError(f"{self._path}:{line}: {sentence}.")

    def _peek(self) -> str:
        return self._tokens[self._next][0] if self._next < len(self._tokens) else ""

    def _take(self) -> str:
        token = self._peek()
        if not token:
            raise self._error("the file ends in the middle of a definition; is a closing brace missing?")
        self._next += 1
        return token

    def _expect(self, sign: str) -> None:
        if self._peek() != sign:
            raise self._error(f"expected {sign!r}, but found {self._peek() or 'the end of the file'!r}")
        self._next += 1

    def _name(self, what: str) -> str:
        token = self._peek()
        if not re.fullmatch(r"\.?[A-Za-z_][\w.]*", token):
            raise self._error(f"expected {what}, but found {token or 'the end of the file'!r}")
        self._next += 1
        return token

    def _integer(self, what: str) -> int:
        token = self._peek()
        try:
            value = int(token, 0) if token.lower().lstrip("-").startswith("0x") else int(token)
        except ValueError:
            raise self._error(f"expected {what}, but found {token or 'the end of the file'!r}") from None
        self._next += 1
        return value

    def _string(self, what: str) -> str:
        token = self._peek()
        if token[:1] not in ("'", '"') or not token:
            raise self._error(f"expected {what} in quotes, but found {token or 'the end of the file'!r}")
        self._next += 1
        return token[1:-1]

    def _skip_statement(self) -> None:
        while self._take() != ";":
            pass

    def _skip_options(self) -> None:
        if self._peek() == "[":
            while self._take() != "]":
                pass

    def file(self, name: str) -> FileDescriptorProto:
        """Parse the whole file; other files import it by `name`."""
        result = FileDescriptorProto(name=name, syntax="proto3")
        while self._peek():
            keyword = self._name("syntax, package, import, option, message or enum")
            if keyword == "syntax":
                self._expect("=")
                syntax = self._string("the syntax")
                if syntax != "proto3":
                    raise self._error(f"expected syntax 'proto3', but found {syntax!r}")
                self._expect(";")
            elif keyword == "package":
                result.package = self._name("a package name")
                self._expect(";")
            elif keyword == "import":
                if self._peek() in ("public", "weak"):
                    self._take()
                result.dependency.append(self._string("the imported file"))
                self._expect(";")
            elif keyword == "option":
                self._skip_statement()
            elif keyword == "message":
                self._message(result.message_type.add())
            elif keyword == "enum":
                self._enum(result.enum_type.add())
            else:
                self._next -= 1
                raise self._error(f"expected syntax, package, import, option, message or enum, but found {keyword!r}")
        return result

    def _message(self, result: DescriptorProto) -> None:
        result.name = self._name("a message name")
        self._expect("{")
        while self._peek() != "}":
            keyword = self._peek()
            if keyword == ";":
                self._take()
            elif keyword == "message":
                self._take()
                self._message(result.nested_type.add())
            elif keyword == "enum":
                self._take()
                self._enum(result.enum_type.add())
            elif keyword in ("option", "reserved"):
                self._skip_statement()
            elif keyword == "oneof":
                self._oneof(result)
            else:
                self._field(result)
        self._expect("}")

    def _oneof(self, message: DescriptorProto) -> None:
        self._take()
        index = len(message.oneof_decl)
        message.oneof_decl.add(name=self._name("a oneof name"))
        self._expect("{")
        while self._peek() != "}":
            if self._peek() == "option":
                self._skip_statement()
            else:
                self._field(message).oneof_index = index
        self._expect("}")

    def _field(self, message: DescriptorProto) -> FieldDescriptorProto:
        field = message.field.add(label=FieldDescriptorProto.LABEL_OPTIONAL)
        type_name = self._name("a field type")
        if type_name == "map" and self._peek() == "<":
            self._map_type(message, field)
            return field
        if type_name in ("repeated", "optional"):
            if type_name == "repeated":
                field.label = FieldDescriptorProto.LABEL_REPEATED
            type_name = self._name("a field type")
        self._set_type(field, type_name)
        self._name_and_number(field)
        return field

    @staticmethod
    def _set_type(field: FieldDescriptorProto, type_name: str) -> None:
        scalar = SCALARS.get(type_name)
        if scalar is not None:
            field.type = scalar
        else:  # message or enum: the descriptor pool resolves it when it links the file
            field.type_name = type_name

    def _name_and_number(self, field: FieldDescriptorProto) -> None:
        field.name = self._name("a field name")
        self._expect("=")
        field.number = self._integer(f"the number of field {field.name!r}")
        first = self._next
        self._skip_options()
        options = [token for token, _ in self._tokens[first : self._next]]
        if "packed" in options:  # the only option that is visible, in `gz msg --info`
            field.options.packed = options[options.index("packed") + 1 :][:2] == ["=", "true"]
        self._expect(";")

    def _map_type(self, message: DescriptorProto, field: FieldDescriptorProto) -> None:
        """Parse a map, which is a repeated nested message with the fields key and value."""
        self._expect("<")
        key = self._name("the key type of the map")
        self._expect(",")
        value = self._name("the value type of the map")
        self._expect(">")
        self._name_and_number(field)
        entry = message.nested_type.add(name="".join(part.capitalize() for part in field.name.split("_")) + "Entry")
        entry.options.map_entry = True
        for number, (name, type_name) in enumerate((("key", key), ("value", value)), start=1):
            part = entry.field.add(name=name, number=number, label=FieldDescriptorProto.LABEL_OPTIONAL)
            self._set_type(part, type_name)
        field.label = FieldDescriptorProto.LABEL_REPEATED
        field.type_name = entry.name

    def _enum(self, result: EnumDescriptorProto) -> None:
        result.name = self._name("an enum name")
        self._expect("{")
        while self._peek() != "}":
            if self._peek() in ("option", "reserved"):
                self._skip_statement()
                continue
            name = self._name("the name of an enum value")
            self._expect("=")
            result.value.add(name=name, number=self._integer(f"the number of {name!r}"))
            self._skip_options()
            self._expect(";")
        self._expect("}")


def read_proto(text: str, name: str, path: str | None = None) -> FileDescriptorProto:
    """Return the descriptor of one `.proto` text.

    Other files import it by `name` ("gz/msgs/twist.proto"); `path` (default: `name`) is used in error messages.
    Raises ProtoSyntaxError.
    """
    return _Reader(text, path or name).file(name)
