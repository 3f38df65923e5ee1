"""Which program runs a component, where components cannot be loaded into a container.

A container is a C++ program that loads C++ libraries; there is none here. Many components also exist as a program of
their own. A package says so in the ament index: `share/ament_index/resource_index/component_programs/PACKAGE` holds
lines `<plugin>;<executable>`.
"""

from __future__ import annotations

from pathlib import Path

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.ament_prefix import prefixes
from gz_course.sim.ros.launch.errors import NotAvailableError

_INDEX = Path("share/ament_index/resource_index/component_programs")


def program_of(package: str, plugin: str) -> str:
    """Return the executable of a package that runs a component. Raises NotAvailableError if none is registered."""
    for prefix in prefixes():
        programs = _programs(prefix / _INDEX / package)
        if plugin in programs:
            return programs[plugin]
    known = {name for prefix in prefixes() for name in _programs(prefix / _INDEX / package)}
    hint = did_you_mean(plugin, known) if known else ""
    raise NotAvailableError(
        f"the component '{plugin}' of '{package}' cannot be loaded: containers need a full ROS 2 installation, and no "
        f"program is registered that runs it{hint}; start it with Node(package=..., executable=...), or switch it off "
        "with its condition"
    )


def _programs(file: Path) -> dict[str, str]:
    if not file.is_file():
        return {}
    pairs = [line.partition(";") for line in file.read_text(encoding="utf-8").splitlines()]
    return {plugin.strip(): program.strip() for plugin, _, program in pairs if program.strip()}
