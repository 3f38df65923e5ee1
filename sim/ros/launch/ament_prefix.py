"""Names of packages and of their launch files, for hints in error messages.

Launch files themselves find packages with `launch_ros.substitutions`.
"""

from __future__ import annotations

import os
import re
from pathlib import Path

from gz_course.sim.did_you_mean import did_you_mean

_INDEX = "share/ament_index/resource_index/packages"


def prefixes() -> list[Path]:
    return [Path(part) for part in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if part]


def package_names() -> set[str]:
    indexes = [prefix / _INDEX for prefix in prefixes()]
    return {path.name for index in indexes if index.is_dir() for path in index.iterdir()}


def packages_with_launch_file(name: str) -> list[str]:
    """Return the packages that have a launch file of this name, sorted."""
    return sorted({path.parts[-3] for prefix in prefixes() for path in prefix.glob(f"share/*/launch/{name}")})


def nearest_package_of(sentence: str) -> str:
    """Return `; did you mean 'x'?` for an error about a missing package, otherwise an empty text."""
    unknown = re.search(r"package '([^']+)' not found", sentence)
    if unknown is None or "did you mean" in sentence:
        return ""
    return did_you_mean(unknown[1], package_names())
