"""What `install()` and `ament_environment_hooks()` of a CMakeLists.txt put into the install prefix.

Source: install, https://cmake.org/cmake/help/latest/command/install.html
Source: ament_cmake_core 2.5 (`ament_environment_hooks.cmake`)
"""

from __future__ import annotations

import fnmatch
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

PYTHON = f"lib/python{sys.version_info.major}.{sys.version_info.minor}/site-packages"
"""The folder of Python modules in an install prefix."""

_WORDS = (
    *("DESTINATION", "RENAME", "PERMISSIONS", "FILE_PERMISSIONS", "DIRECTORY_PERMISSIONS", "USE_SOURCE_PERMISSIONS"),
    *("OPTIONAL", "COMPONENT", "CONFIGURATIONS", "MESSAGE_NEVER", "FILES_MATCHING", "PATTERN", "REGEX"),
    *("EXCLUDE_FROM_ALL", "TYPE"),
)


class UnknownFormError(Exception):
    """A form of `install()` that is not read; its text is what was seen and expected."""


@dataclass(frozen=True)
class InstalledFiles:
    """A file, or a folder with what is in it: the content of `source` if that ends with `/`, else the folder itself.

    Paths that end like one of `excluded` are left out; of `only`, if there are any, one must match. Both are regular
    expressions.
    """

    source: str
    destination: str
    line: int
    executable: bool = False
    optional: bool = False
    name: str = ""
    only: tuple[str, ...] = ()
    excluded: tuple[str, ...] = ()

    def files(self, folder: Path) -> Iterator[tuple[Path, str]]:
        """Yield each file and its path in the install prefix. `folder` is that of the CMakeLists.txt.

        Raises FileNotFoundError.
        """
        source = folder / self.source
        if source.is_file():
            yield source, f"{self.destination}/{self.name or source.name}".lstrip("/")
            return
        if not source.is_dir():
            if self.optional:
                return
            raise FileNotFoundError(source)
        start = self.destination if self.source.endswith("/") else f"{self.destination}/{source.name}"
        for path in sorted(source.rglob("*")):
            inner = path.relative_to(source)
            if path.is_dir() or "__pycache__" in inner.parts:
                continue
            parts = [f"/{Path(*inner.parts[: end + 1]).as_posix()}" for end in range(len(inner.parts))]
            if any(re.search(pattern, part) for pattern in self.excluded for part in parts):
                continue
            if not self.only or any(re.search(pattern, parts[-1]) for pattern in self.only):
                yield path, f"{start}/{inner.as_posix()}".lstrip("/")


@dataclass(frozen=True)
class Hook:
    """A file that `source install/setup.bash` reads. In one that ends with `.in`, a variable stands for `@NAME@`."""

    source: str
    line: int
    variables: dict[str, str]

    @property
    def name(self) -> str:
        return Path(self.source).name.removesuffix(".in")

    def text(self, folder: Path, prefix: Path) -> str:
        """Return the content to install in a prefix. Raises OSError and UnicodeDecodeError."""
        text = (folder / self.source).read_text(encoding="utf-8")
        if not self.source.endswith(".in"):
            return text
        known = {**self.variables, "CMAKE_INSTALL_PREFIX": str(prefix)}
        return re.sub(r"@([A-Za-z0-9_]+)@", lambda match: known.get(match[1], ""), text)


def read(values: Sequence[str], line: int) -> list[InstalledFiles]:
    """Return what the arguments of one `install()` put into the prefix. Raises UnknownFormError."""
    kind = values[0] if values else ""
    if kind not in ("DIRECTORY", "FILES", "PROGRAMS"):
        raise UnknownFormError("only DIRECTORY, FILES and PROGRAMS are read")
    parts = by_keyword(values[1:], _WORDS)
    if not parts.get("DESTINATION"):
        raise UnknownFormError("expected DESTINATION and a folder")
    destination = parts["DESTINATION"][0].strip("/") or "."
    if ".." in Path(destination).parts:
        raise UnknownFormError(f"the destination '{destination}' leads out of the install prefix")
    only, excluded = _patterns(values)
    return [
        InstalledFiles(
            source,
            destination,
            line,
            executable=kind == "PROGRAMS",
            optional="OPTIONAL" in parts,
            name=(*parts.get("RENAME", ()), "")[0],
            only=only,
            excluded=excluded,
        )
        for source in parts[""]
    ]


def by_keyword(values: Sequence[str], words: Sequence[str]) -> dict[str, list[str]]:
    """Return the values after each keyword; those before the first one are under an empty name."""
    found: dict[str, list[str]] = {"": []}
    word = ""
    for value in values:
        if value in words:
            word = value
            found.setdefault(word, [])
        else:
            found[word].append(value)
    return found


def _patterns(values: Sequence[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the patterns of files to install, and of those to leave out, as regular expressions."""
    kept: list[str] = []
    excluded: list[str] = []
    for index, value in enumerate(values[:-1]):
        if value in ("PATTERN", "REGEX"):
            text = values[index + 1]
            pattern = text if value == "REGEX" else "/" + fnmatch.translate(text)
            (excluded if values[index + 2 : index + 3] == ["EXCLUDE"] else kept).append(pattern)
    return tuple(kept) if "FILES_MATCHING" in values else (), tuple(excluded)
