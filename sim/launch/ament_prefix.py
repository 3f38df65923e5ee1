"""Names of packages and of their launch files, for hints in error messages.

Launch files themselves find packages with `launch_ros.substitutions`.
"""

from __future__ import annotations

import difflib
import os
import re
from pathlib import Path

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
    close = difflib.get_close_matches(unknown[1], package_names(), n=1, cutoff=0.6)
    return f"; did you mean '{close[0]}'?" if close else ""
