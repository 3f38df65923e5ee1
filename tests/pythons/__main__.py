"""Try the course on every Python of this machine, and print one line for each command."""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

from .interpreters import PROMISED, found
from .trial import tried

CHECKOUT = Path(__file__).resolve().parents[2]


def main() -> int:
    """Return 0 if every command succeeded with every Python, 1 if one did not, 2 if there is no Python to try."""
    parser = argparse.ArgumentParser(prog="make pythons", description=main.__doc__)
    parser.add_argument("pythons", nargs="*", help="paths or commands; all that are installed if left out")
    parser.add_argument("--others", action="store_true", help="leave out the version that runs this command")
    parser.add_argument("--solutions", action="store_true", help="run the demo and all solutions only, never the suite")
    options = parser.parse_args()
    interpreters = found(options.pythons)
    if options.others:
        interpreters = [each for each in interpreters if each.version[:2] != sys.version_info[:2]]
    if not interpreters:
        print(f"no Python to try: looked for CPython {', '.join(f'{a}.{b}' for a, b in PROMISED)}")
        return 0 if options.others else 2
    if subprocess.run(["git", "status", "--porcelain"], cwd=CHECKOUT, capture_output=True, check=True).stdout:
        print("note: what is not committed is not tried")
    good = True
    for interpreter in interpreters:
        print(f"{interpreter.name}  {interpreter.path}", flush=True)
        with tempfile.TemporaryDirectory(prefix="pythons-", ignore_cleanup_errors=True) as folder:
            for outcome in tried(interpreter, CHECKOUT, Path(folder), suite=not options.solutions):
                mark = "ok" if outcome.succeeded else "FAILED"
                print(f"  {mark:6} {outcome.seconds:5.0f} s  {outcome.command}: {outcome.said}", flush=True)
                if not outcome.succeeded:
                    good = False
                    _show_end(outcome.log)
    return 0 if good else 1


def _show_end(log: Path, lines: int = 60) -> None:
    for line in log.read_text(errors="replace").splitlines()[-lines:]:
        print(f"    | {line}")


if __name__ == "__main__":
    sys.exit(main())
