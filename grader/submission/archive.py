"""Readers of students' archives, which are untrusted: members of a .zip or .tar.gz by name, each read on request.

Nothing is ever unpacked to disk. `intake.py` opens what one student handed in, `whole_class/` the archive of a class.
Claimed sizes are checked before anything is read, and the bytes read are counted, because a claim may be false.
"""

from __future__ import annotations

import gzip
import io
import stat
import struct
import tarfile
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import PurePosixPath
from typing import IO, BinaryIO, cast

from gz_course.grader.errors import RefusedError, UsageError
from gz_course.grader.printable import shown

SUFFIXES = (".zip", ".tar.gz", ".tgz", ".tar")
OTHER_SUFFIXES = (".7z", ".rar", ".tar.bz2", ".tar.xz", ".tbz2", ".txz", ".gz", ".xz", ".bz2", ".zst")  # not supported
LARGEST_ARCHIVE = 16 << 20  # [bytes] of a student's archive as it was sent
LARGEST_STREAM = 64 << 20  # [bytes] a compressed tar may expand to while it is read
MOST_MEMBERS = 10_000  # that are listed; fewer are accepted (`intake.MOST_FILES`)
LONGEST_PART, LONGEST_NAME = 255, 1_000  # [bytes] of one part of a name, and of the whole name
CENTRAL_HEADER = b"PK\x01\x02"  # the signature each member of a zip has


@dataclass(frozen=True)
class Member:
    """A file in an archive or a folder: its claimed size [bytes], how to read it, and why that is refused, if so.

    `read(most)` returns at most `most` bytes. `modified` is when the file claims to have been changed; without a time
    zone it is the local time of an unknown place.
    """

    size: int
    read: Callable[[int], bytes]
    refusal: str | None = None
    modified: datetime | None = None


Tree = dict[str, Member]  # relative name with `/` between its parts -> member


def is_archive(name: str) -> bool:
    """Return whether a file has the name of an archive, including types that cannot be opened here."""
    return name.lower().endswith(SUFFIXES + OTHER_SUFFIXES)


def open_archive(name: str, data: bytes) -> Tree:
    """Return the members of a student's archive called `name`.

    Raises RefusedError if it is not safe to read, UsageError if it is damaged or of an unsupported type.
    """
    name = shown(name)
    if not name.lower().endswith(SUFFIXES):
        raise UsageError(f"{name}: archives of this kind are not opened; send a .zip or a .tar.gz")
    if data.count(CENTRAL_HEADER) > MOST_MEMBERS:  # before zipfile creates an object for each
        raise RefusedError(f"{name} holds too many files: more than {MOST_MEMBERS}")
    tree: Tree = {}
    try:
        members = zip_members(io.BytesIO(data)) if name.lower().endswith(".zip") else _tar_members(name, data)
        for raw, member in members:
            if len(tree) >= MOST_MEMBERS:
                raise RefusedError(f"{name} holds too many files: more than {MOST_MEMBERS}")
            tree[plain_name(raw, name)] = member
    except UsageError:
        raise
    except Exception as error:  # the exceptions that readers raise for deliberately damaged archives are not documented
        raise damaged(name, error) from None
    return tree


def damaged(name: str, error: Exception) -> UsageError:
    """Return the error for an archive that cannot be read."""
    return UsageError(f"{name} cannot be read as an archive: {shown(str(error)) or type(error).__name__}")


def plain_name(raw: str, archive: str) -> str:
    """Return a member's normalised name. Raises RefusedError if it leads out of the archive or is not a file name."""
    name = raw.replace("\\", "/")  # as archivers on Windows write it
    parts = PurePosixPath(name).parts
    outside = name.startswith("/") or ".." in parts or name[1:2] == ":"
    plain = "/".join(parts)
    encoded = [part.encode("utf-8", "surrogateescape") for part in parts]
    if outside or not parts or "\0" in name:
        raise RefusedError(f"{archive} holds a file called {shown(raw)!r}, which leads out of it; pack the folder")
    if len(plain.encode("utf-8", "surrogateescape")) > LONGEST_NAME or max(map(len, encoded)) > LONGEST_PART:
        raise RefusedError(f"{archive} holds a file with too long a name: {shown(raw, 60)!r}")
    return plain


def zip_members(stream: BinaryIO) -> Iterator[tuple[str, Member]]:
    """Yield the files of a zip: name as written in it and member, unpacked only when read.

    Raises the exceptions of `zipfile`.
    """
    archive = zipfile.ZipFile(stream)
    for info in archive.infolist():
        if not info.filename.endswith("/"):
            reader, refusal = _zip_reader(archive, info), _zip_refusal(info)
            yield _zip_name(info), Member(info.file_size, reader, refusal, _zip_time(info))


def zip_folders(stream: BinaryIO) -> list[str]:
    """Return the folders that have an entry of their own in a zip, as empty ones do.

    Raises the exceptions of `zipfile`.
    """
    infos = zipfile.ZipFile(stream).infolist()
    return [_zip_name(info).rstrip("/") for info in infos if info.filename.endswith("/")]


def _zip_name(info: zipfile.ZipInfo) -> str:
    """Return a member's name; many archivers write UTF-8 without the flag, which `zipfile` reads as code page 437.

    Source: PKWARE APPNOTE.TXT, 4.4.4 (bit 11) and appendix D.
    """
    if not info.flag_bits & 0x800:
        try:
            return info.filename.encode("cp437").decode("utf-8")
        except UnicodeError:
            pass
    return info.filename


def _zip_time(info: zipfile.ZipInfo) -> datetime | None:
    """Return when a member was changed: in UTC if the extended timestamp is there, else in somebody's local time.

    Source: Info-ZIP, `proginfo/extrafld.txt`, "Extended Timestamp Extra Field" (0x5455).
    """
    extra = info.extra
    while len(extra) >= 4:
        kind, size = struct.unpack_from("<HH", extra)
        field, extra = extra[4 : 4 + size], extra[4 + size :]
        if kind == 0x5455 and len(field) >= 5 and field[0] & 1:
            return datetime.fromtimestamp(struct.unpack_from("<i", field, 1)[0], UTC)
    try:
        return datetime(*info.date_time)
    except ValueError:  # month 0, as archivers write that have no date
        return None


def _zip_refusal(info: zipfile.ZipInfo) -> str | None:
    kind = stat.S_IFMT(info.external_attr >> 16)
    if kind not in (0, stat.S_IFREG):
        return "is a link" if stat.S_ISLNK(kind) else "is a device or a pipe"
    if info.flag_bits & 0x1:
        return "is encrypted"
    if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        return f"is packed by method {info.compress_type}"
    return None


def _zip_reader(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> Callable[[int], bytes]:
    def read(most: int) -> bytes:
        with archive.open(info) as stream:
            return stream.read(most)

    return read


class _Counted(io.RawIOBase):
    """A stream that raises RefusedError after a number of bytes."""

    def __init__(self, stream: IO[bytes], name: str) -> None:
        self._stream, self._name, self._left = stream, name, LARGEST_STREAM

    def readable(self) -> bool:
        return True

    def read(self, size: int = -1) -> bytes:
        data = self._stream.read(min(size, self._left + 1) if size >= 0 else self._left + 1)
        self._left -= len(data)
        if self._left < 0:
            raise RefusedError(f"{self._name} is too large: unpacked it has more than {LARGEST_STREAM} bytes")
        return data


def _tar_members(name: str, data: bytes) -> Iterator[tuple[str, Member]]:
    """Yield the files of a tar, compressed or not, in one pass that reads their contents."""
    raw: IO[bytes] = io.BytesIO(data)
    stream = raw if name.lower().endswith(".tar") else cast(IO[bytes], gzip.GzipFile(fileobj=raw))
    with tarfile.open(fileobj=cast(IO[bytes], _Counted(stream, name)), mode="r|") as archive:
        for info in archive:
            if info.isdir():
                continue
            refusal = None
            if info.issym() or info.islnk():
                refusal = "is a link"
            elif not info.isreg():
                refusal = "is a device or a pipe"
            elif info.issparse():
                refusal = "is sparse"
            content = b""
            if refusal is None and (file := archive.extractfile(info)) is not None:
                content = file.read()  # the stream counts the bytes
            yield info.name, Member(info.size, _cutter(content), refusal)


def _cutter(content: bytes) -> Callable[[int], bytes]:
    return lambda most: content[:most]
