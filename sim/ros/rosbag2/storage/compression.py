"""Bags whose files, or whose messages, are compressed with Zstandard.

Source: rosbag2_compression 0.26, rosbag2_compression_zstd (`sequential_compression_writer.cpp`): suffix, level
"""

from __future__ import annotations

import shutil
from pathlib import Path

from gz_course.sim.ros.rosbag2.errors import BagError

FORMAT = "zstd"
MODES = ("none", "file", "message")
SUFFIXES = (".zstd", ".zst")
MAGIC = b"\x28\xb5\x2f\xfd"  # no message begins so: the first byte of CDR is 0
_LEVEL = 1
_LARGEST_MESSAGE = 1 << 30  # bytes


def compress_file(path: Path) -> Path:
    """Replace a file by a compressed one, and return its path. Raises OSError; then the file is as before."""
    import zstandard

    target = path.with_name(path.name + SUFFIXES[0])
    draft = target.with_name(target.name + ".part")
    try:
        with path.open("rb") as source, draft.open("wb") as packed:
            zstandard.ZstdCompressor(level=_LEVEL).copy_stream(source, packed, size=path.stat().st_size)
        draft.replace(target)
    except OSError:
        draft.unlink(missing_ok=True)
        raise
    path.unlink()
    return target


def unpack_file(path: Path, folder: Path) -> Path:
    """Write the content of a compressed file into a folder; return its path. Raises BagError."""
    import zstandard

    target = folder / path.name.removesuffix(path.suffix)
    most = shutil.disk_usage(folder).free // 2
    written = 0
    try:
        with path.open("rb") as packed, target.open("wb") as whole:
            for piece in zstandard.ZstdDecompressor().read_to_iter(packed):
                written += len(piece)
                if written > most:
                    raise BagError(f"{path} unpacks to more than half of the free space of {folder}")
                whole.write(piece)
    except zstandard.ZstdError as error:
        raise BagError(f"{path} is damaged: {error}") from None
    except OSError as error:
        raise BagError(f"{path} cannot be unpacked into {folder}: {error.strerror}") from None
    return target


def compress_message(data: bytes) -> bytes:
    import zstandard

    return zstandard.ZstdCompressor(level=_LEVEL).compress(data)


def unpack_message(data: bytes, topic: str) -> bytes:
    """Return a message as it was sent; one that is not compressed is returned as it is. Raises BagError."""
    import zstandard

    if not data.startswith(MAGIC):
        return data
    try:
        size = zstandard.frame_content_size(data)
        if size > _LARGEST_MESSAGE:
            raise BagError(f"a message of '{topic}' claims to have {size} bytes")
        return zstandard.ZstdDecompressor().decompress(data, max_output_size=_LARGEST_MESSAGE)
    except (zstandard.ZstdError, MemoryError) as error:
        raise BagError(f"a message of '{topic}' is damaged: {error}") from None
