"""Try a folder of worlds and compare with the table: `python -m gz_course.tests.worlds DIR [--jobs N] [--write]`.

DIR is a checkout of gz-sim, or any folder of worlds (`*.sdf`, `*.world`). Each world is loaded and stepped in a process
of its own, with limits of memory and processor time. Exit code 1 if one does not what the table says, 2 for a wrong
call. With `--write` the table gets what was found, and the exit code is 0.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from gz_course.tests.worlds import table
from gz_course.tests.worlds.table import UNTRIED, Outcome

PATIENCE_S = 1800.0  # only against a process that sleeps for ever
_OF_GZ_SIM = ("examples/worlds", "test/worlds")
_ENDINGS = (".sdf", ".world")


def worlds_in(folder: Path) -> dict[str, Path]:
    """Return the world files of a folder by name; those of a checkout of gz-sim are named from its root."""
    rooms = [folder / room for room in _OF_GZ_SIM if (folder / room).is_dir()] or [folder]
    files = (path for room in rooms for path in room.rglob("*") if path.suffix in _ENDINGS and path.is_file())
    return {str(path.relative_to(folder)): path for path in sorted(files)}


def attempt(path: Path, folder: Path) -> Outcome:
    """Return what one world does in a process of its own."""
    with tempfile.TemporaryDirectory(prefix="gz_worlds_") as home:
        environment = {name: value for name, value in os.environ.items() if not name.startswith(("GZ_", "IGN_"))}
        environment |= {"HOME": home, "MUJOCO_GL": "disable"}
        command = [sys.executable, "-m", "gz_course.tests.worlds.one_world", str(path)]
        child = subprocess.Popen(
            command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=home,
            start_new_session=True,
        )  # fmt: skip
        try:
            out, error = child.communicate(timeout=PATIENCE_S)
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, 9)
            child.communicate()
            return Outcome("ended", (f"it did not end within {PATIENCE_S:g} s",))
        last = out.strip().rpartition("\n")[2]
        if child.returncode != 0 or not last.startswith("{"):
            why = error.strip().rpartition("\n")[2] or f"exit code {child.returncode}"
            return table.outcome("ended", [why], {str(folder): "DIR", home: "HOME"})
        found = json.loads(last)
        return table.outcome(found["kind"], found["said"], {str(folder): "DIR", home: "HOME"})


def named(name: str, known: dict[str, Outcome]) -> str:
    """Return the name in the table of a file called `name` in its folder: the same, or one that ends with it."""
    ends = [each for each in known if each == name or each.endswith(f"/{name}")]
    return name if name in known or len(ends) != 1 else ends[0]


def compare(name: str, found: Outcome, wanted: Outcome | None) -> Iterator[str]:
    """Yield the lines about one world; the first begins with `differs` where the table says something else."""
    if wanted is None or wanted.kind == UNTRIED:
        yield f"not in the table yet: {name}: {found}"
    elif found != wanted:
        yield f"differs: {name}: {found.kind} (table: {wanted.kind})"
        yield from (f"    + {text}" for text in found.sentences if text not in wanted.sentences)
        yield from (f"    - {text}" for text in wanted.sentences if text not in found.sentences)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="make worlds", description="try worlds and compare with the table")
    parser.add_argument("folder", metavar="DIR", type=Path)
    parser.add_argument("--table", type=Path, default=table.TABLE)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--write", action="store_true", help="put what is found into the table")
    values = parser.parse_args(arguments)
    folder = values.folder.resolve()
    files = worlds_in(folder) if folder.is_dir() else {}
    if not files:
        parser.error(f"there is no world (*.sdf, *.world) in {values.folder}")
    known = table.read(values.table) if values.table.is_file() else {}
    different = new = 0
    with ThreadPoolExecutor(values.jobs) as pool:
        outcomes = pool.map(lambda path: attempt(path, folder), files.values())
        for file, found in zip(files, outcomes, strict=True):
            name = named(file, known)
            for line in compare(name, found, known.get(name)):
                print(line, flush=True)
                different += line.startswith("differs")
                new += line.startswith("not in")
            if values.write:
                known[name] = found
    if values.write:
        table.write(known, values.table)
    print(f"{len(files)} worlds tried: {different} differ, {new} not in the table yet")
    return 1 if different and not values.write else 0


if __name__ == "__main__":
    raise SystemExit(main())
