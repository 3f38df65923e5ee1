"""A panel beside the notebook in JupyterLab, which stays where it is while one scrolls; other front ends have none.

Source: https://github.com/jupyter-widgets/jupyterlab-sidecar
"""

from __future__ import annotations

import importlib
import os
from pathlib import Path
from typing import Any

import psutil

PROGRAMS = {"jupyter-lab", "jupyterlab"}
"""Words of the command line of a server whose page is JupyterLab."""


class SidePanel:
    """A panel with HTML, until `close`."""

    def __init__(self, title: str, content: str) -> None:
        """Open it. Raises ModuleNotFoundError if `sidecar` is not installed."""
        output = {"output_type": "display_data", "data": {"text/html": content, "text/plain": title}, "metadata": {}}
        self._widget: Any = importlib.import_module("sidecar").Sidecar(title=title, anchor="split-right")
        self._widget.outputs = (output,)

    def close(self) -> None:
        self._widget.close()


def in_jupyterlab() -> bool:
    """Return whether this is a kernel that JupyterLab's server has started."""
    try:
        words = psutil.Process(os.getppid()).cmdline()
    except psutil.Error:
        return False
    return any(Path(word).name in PROGRAMS for word in words[:3])
