"""Registries that are folders: a command, a report format, a check or a look is added by adding its file."""

from __future__ import annotations

import importlib
from collections.abc import Iterable, Mapping
from graphlib import TopologicalSorter
from heapq import heapify, heappop, heappush
from pathlib import Path
from types import ModuleType

from gz_course.sim.did_you_mean import did_you_mean


def module_names(package: ModuleType) -> list[str]:
    """Return the names of the modules in a package, sorted, without importing them."""
    return sorted(path.stem for folder in package.__path__ for path in Path(folder).glob("[!_]*.py"))


def modules(package: ModuleType) -> dict[str, ModuleType]:
    """Import every module of a package: name -> module, sorted by name."""
    return {name: importlib.import_module(f"{package.__name__}.{name}") for name in module_names(package)}


def modules_below(package: ModuleType) -> list[ModuleType]:
    """Import every module of a package and of the packages in it, sorted by name within each."""
    found = list(modules(package).values())
    for name in sorted(
        {path.parent.name for folder in package.__path__ for path in Path(folder).glob("[!_]*/__init__.py")}
    ):
        found += modules_below(importlib.import_module(f"{package.__name__}.{name}"))
    return found


def in_order(before: Mapping[str, Iterable[str]]) -> list[str]:
    """Sort names, each of which stands before the names it is mapped to; alphabetically where that leaves a choice.

    Raises ValueError for an unknown name, `graphlib.CycleError` (a ValueError) if there is a cycle.
    """
    sorter: TopologicalSorter[str] = TopologicalSorter({name: () for name in before})
    for name, others in before.items():
        for other in others:
            if other not in before:
                hint = did_you_mean(other, before, listing="known")
                raise ValueError(f"{name} stands before {other!r}, which does not exist{hint}")
            sorter.add(other, name)
    sorter.prepare()
    ready, order = list(sorter.get_ready()), []
    heapify(ready)
    while ready:
        order.append(heappop(ready))
        sorter.done(order[-1])
        for name in sorter.get_ready():
            heappush(ready, name)
    return order
