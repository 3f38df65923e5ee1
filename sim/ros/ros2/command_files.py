"""The files of the commands of `ros2` and of their verbs: which there are, and the module of one."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

COMMANDS = Path(__file__).parent / "command"


def found(folder: Path) -> dict[str, Path]:
    """Return the files or folders of the commands, or of the verbs of a command, sorted by name."""
    paths = {path.stem: path for path in folder.iterdir() if path.suffix == ".py" or path.is_dir()}
    return {name: paths[name] for name in sorted(paths) if not name.startswith("_")}


def load(path: Path) -> Any:
    """Return the module of a command or verb, with its `main` and `add_arguments`."""
    return importlib.import_module(
        ".".join([__package__ or "", *path.relative_to(COMMANDS.parent).with_suffix("").parts])
    )
