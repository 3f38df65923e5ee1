"""Gazebo's own log library reads what LogRecord writes."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from gz_course.sim.gz.sim.tlog import FILE_NAME, Entry, LogWriter

PACKAGE = "ignition-transport11-log"
NEEDS_CLIENT = False


def flags() -> list[str]:
    """What the compiler needs to find Gazebo's log library; skips where it is not installed."""
    if not (shutil.which("g++") and shutil.which("pkg-config")):
        pytest.skip("no C++ compiler")
    asked = subprocess.run(["pkg-config", "--cflags", "--libs", PACKAGE], capture_output=True, text=True)
    if asked.returncode != 0:
        pytest.skip(f"Debian's libignition-transport-dev ({PACKAGE}) is not installed")
    return asked.stdout.split()


def test_the_library_of_gazebo_reads_our_log(tmp_path: Path) -> None:
    program, log = tmp_path / "log_reader", tmp_path / FILE_NAME
    source = Path(__file__).with_name("log_reader.cc")
    subprocess.run(["g++", "-std=c++17", "-O0", source, "-o", program, *flags()], check=True, timeout=600)
    writer = LogWriter(log)
    for number in range(3):
        writer.write(Entry(f"/topic_{number % 2}", "gz.msgs.StringMsg", number * 1000, f"data{number}".encode()))
    writer.close()
    read = subprocess.run([program, log], check=True, capture_output=True, text=True, timeout=600)
    assert read.stdout.splitlines() == [
        "0.1.0 0 2000",
        "0 /topic_0 gz.msgs.StringMsg data0",
        "1000 /topic_1 gz.msgs.StringMsg data1",
        "2000 /topic_0 gz.msgs.StringMsg data2",
    ]
