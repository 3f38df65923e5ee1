"""`make bench`: runs every benchmark of this folder and prints one table.

A benchmark is a module with `rows() -> Iterator[Row]`. Each row compares something with a reference measured in the
same run; nothing here fails a build.
"""

import importlib
import pkgutil
import sys
from pathlib import Path

from rich.console import Console
from rich.table import Table

from gz_course.tests import bench


def main() -> None:
    chosen = sys.argv[1:]
    console = Console(width=140)
    table = Table(box=None, padding=(0, 2, 0, 0))
    for heading in ("benchmark", "measured", "reference", "ratio", "wanted"):
        table.add_column(heading)
    for module in pkgutil.iter_modules([str(Path(bench.__path__[0]))]):
        if module.name == "__main__" or not module.name.startswith("bench_") or (chosen and module.name not in chosen):
            continue
        for row in importlib.import_module(f"gz_course.tests.bench.{module.name}").rows():
            console.print(f"done: {row.name}: {row.measured}", highlight=False, style="dim")
            table.add_row(row.name, row.measured, row.reference, row.ratio, row.wanted)
    console.print(table)


if __name__ == "__main__":
    main()
