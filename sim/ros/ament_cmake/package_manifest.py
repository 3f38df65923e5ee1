"""Reads what a package.xml says of dependencies and groups.

Source: REP-149, https://www.ros.org/reps/rep-0149.html
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from gz_course.sim.ros.ament_cmake.errors import PackageError

_DEPENDENCIES = ("depend", "build_depend", "build_export_depend", "exec_depend")


@dataclass(frozen=True)
class PackageManifest:
    """The name of a package, the packages it needs, its groups, and its build type."""

    path: Path
    name: str
    dependencies: frozenset[str]
    groups: frozenset[str]
    build_type: str = "ament_cmake"


def read_manifest(path: Path) -> PackageManifest:
    """Return the content of a package.xml. Raises PackageError."""
    try:
        root = ElementTree.fromstring(path.read_bytes())
    except ElementTree.ParseError as error:
        raise PackageError(f"this is not XML: {error}", path, error.position[0]) from None
    except (OSError, ValueError, LookupError) as error:
        raise PackageError(f"the file cannot be read: {error}", path) from None

    def texts(*tags: str) -> frozenset[str]:
        return frozenset(each.text.strip() for tag in tags for each in root.findall(tag) if each.text)

    name = (root.findtext("name") or "").strip()
    build_type = (root.findtext("export/build_type") or "catkin").strip()
    return PackageManifest(path, name, texts(*_DEPENDENCIES), texts("member_of_group"), build_type)
