"""libsdformat, which Gazebo reads its files with, in a process of its own: built once from a source of this folder.

Needs Debian's `libsdformat-dev` and `g++`; who asks is skipped where they are missing.
"""

import contextlib
import json
import shutil
import subprocess
from pathlib import Path

import pytest


@contextlib.contextmanager
def libsdformat(source, folder):
    """A function that reads one file; `source` is the name of the program, `folder` where it is built."""
    if shutil.which("g++") is None or shutil.which("pkg-config") is None:
        pytest.skip("conformance with libsdformat was NOT tested: install g++ and pkg-config")
    flags = subprocess.run(["pkg-config", "--cflags", "--libs", "sdformat12"], capture_output=True, text=True)
    if flags.returncode:
        pytest.skip("conformance with libsdformat was NOT tested: install libsdformat-dev (Debian 12)")
    program = folder / Path(source).stem
    command = ["g++", Path(__file__).with_name(source), "-o", program, *flags.stdout.split()]
    subprocess.run(command, check=True, timeout=600)
    process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def read(path: Path) -> dict:
        process.stdin.write(f"{path}\n")
        process.stdin.flush()
        return json.loads(process.stdout.readline())

    yield read
    process.communicate(timeout=600)
