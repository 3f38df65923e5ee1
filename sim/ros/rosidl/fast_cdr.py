"""The buffer of Fast CDR from which a message is read, and to which it is written.

Where the buffer has its address and size is no part of the library's interface. It is measured when this module is
imported, on objects made for that.
"""

from __future__ import annotations

import ctypes as c

_WORD = c.sizeof(c.c_void_p)
_LIBRARY = "libfastcdr.so.2"
_FAST_BUFFER = "_ZN8eprosima7fastcdr10FastBufferC1EPcm"
_CDR = "_ZN8eprosima7fastcdr3CdrC1ERNS0_10FastBufferENS1_10EndiannessENS0_10CdrVersionE"
_WRITE = "_ZN8eprosima7fastcdr3Cdr15serialize_arrayEPKcm"
_POSITION = "_ZNK8eprosima7fastcdr3Cdr26get_serialized_data_lengthEv"
_LITTLE_ENDIAN, _XCDR_1 = 1, 1


class LayoutError(ImportError):
    """The installed Fast CDR is not the one this was written for."""


def _library() -> c.PyDLL:
    # PyDLL: the lock of the interpreter is not released in a call, which would let other threads run while Fast DDS
    # holds locks of its own.
    try:
        library = c.PyDLL(_LIBRARY)
        for name in (_FAST_BUFFER, _CDR, _WRITE, _POSITION):
            getattr(library, name)
    except (OSError, AttributeError) as error:
        raise LayoutError(_sentence(str(error))) from None
    return library


def _sentence(seen: str) -> str:
    return (
        f"interfaces without a compiled package need Fast CDR 2.2 as in ros-fastcdr 2.2.5, but {seen}; "
        "install the versions of the course again (pip install --force-reinstall gz-ros2-course)"
    )


class _Measured:
    """A buffer of known address and size, and where they were found."""

    def __init__(self, library: c.PyDLL) -> None:
        size = 4808  # a number that is found nowhere else in the objects
        data, buffer, cdr = (c.create_string_buffer(n) for n in (size, 16 * _WORD, 64 * _WORD))
        make_buffer = c.PYFUNCTYPE(None, c.c_void_p, c.c_void_p, c.c_size_t)((_FAST_BUFFER, library))
        make_cdr = c.PYFUNCTYPE(None, c.c_void_p, c.c_void_p, c.c_uint8, c.c_uint8)((_CDR, library))
        make_buffer(c.addressof(buffer), c.addressof(data), size)
        make_cdr(c.addressof(cdr), c.addressof(buffer), _LITTLE_ENDIAN, _XCDR_1)
        self.buffer = self._place(cdr, c.addressof(buffer), "the address of the buffer")
        self.start = self._place(buffer, c.addressof(data), "the address of the bytes")
        self.size = self._place(buffer, size, "the number of bytes")
        write(c.addressof(cdr), data=b"four", size=4)
        if position(c.addressof(cdr)) != 4 or data.raw[:4] != b"four":
            raise LayoutError(_sentence("it does not write where it was expected to"))

    @staticmethod
    def _place(memory: c.Array[c.c_char], value: int, what: str) -> int:
        words = (c.c_uint64 * (len(memory) // _WORD)).from_buffer(memory)
        places = [index * _WORD for index, word in enumerate(words) if word == value]
        if len(places) != 1:
            raise LayoutError(_sentence(f"{what} was found at {len(places)} places instead of one"))
        return places[0]


_lib = _library()
write = c.PYFUNCTYPE(c.c_void_p, c.c_void_p, c.c_char_p, c.c_size_t)(
    (_WRITE, _lib), ((1, "cdr"), (1, "data"), (1, "size"))
)
"""Append bytes to the buffer of a Cdr: `write(cdr, data=..., size=...)`."""
position = c.PYFUNCTYPE(c.c_size_t, c.c_void_p)((_POSITION, _lib))
"""Return how many bytes have been read or written: 4 after the encapsulation header."""
_places = _Measured(_lib)


def received(cdr: int) -> tuple[bytes, bytes]:
    """Return the encapsulation header and a copy of all bytes after the current position."""
    buffer = c.c_void_p.from_address(cdr + _places.buffer).value or 0
    start = c.c_void_p.from_address(buffer + _places.start).value
    size = c.c_size_t.from_address(buffer + _places.size).value
    begin = position(cdr)
    if not start or begin < 4 or begin > size:
        return b"", b""
    return c.string_at(start, 4), c.string_at(start + begin, size - begin)
