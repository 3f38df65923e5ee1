"""`python -I grader/tools/pip_progress.py WORDS...` runs `pip install WORDS...` and says in one line how far it is.

The Makefile runs it before the course is installed, so it imports nothing else. What pip says on stderr, such as an
error, comes through. On a terminal the line is written over; elsewhere a stage is a line.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Iterable, Iterator

PIP = [sys.executable, "-m", "pip", "--disable-pip-version-check", "install", "--progress-bar", "off"]
FOUND = re.compile(r"\s*(?:Collecting|Obtaining) (\S+)")
LOADED = re.compile(r"\s*Downloading \S+ \(([\d.]+) (kB|MB|GB)\)")
MEGABYTES = {"kB": 0.001, "MB": 1.0, "GB": 1000.0}
STAGE = 40
"""Packages between two lines where the line cannot be written over."""


def sentences(lines: Iterable[str]) -> Iterator[tuple[bool, str]]:
    """Yield what to say about the output of pip, and whether it is a new stage."""
    packages, megabytes = 0, 0.0
    for line in lines:
        if found := FOUND.match(line):
            packages += 1
            name = "the course" if "://" in found[1] else re.split(r"[^\w.-]", found[1])[0]
            stage = packages % STAGE == 1
            yield stage, f"pip: package {packages}, {megabytes:.0f} MB loaded; looks at {name}"
        elif loaded := LOADED.match(line):
            megabytes += float(loaded[1]) * MEGABYTES[loaded[2]]
        elif line.startswith("Installing collected packages:"):
            count = line.count(",") + 1
            yield True, f"pip: {megabytes:.0f} MB loaded; installs {count} packages, which takes a minute"


def main(words: list[str]) -> int:
    """Run pip and return its exit code."""
    live, wrote = sys.stdout.isatty(), False
    with subprocess.Popen([*PIP, *words], stdout=subprocess.PIPE, text=True, errors="replace") as pip:
        assert pip.stdout is not None
        for stage, sentence in sentences(pip.stdout):
            if live:
                print("\r\x1b[K" + sentence[: shutil.get_terminal_size().columns - 1], end="", flush=True)
                wrote = True
            elif stage:
                print(sentence, flush=True)
    if wrote:
        print("\r\x1b[K", end="", flush=True)
    return pip.returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
