"""The same world, seed and commands give the same bytes on every topic, in any process and under any load."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = Path(__file__).with_name("world_digest.py")


def start(seed: int, hash_seed: str) -> subprocess.Popen[str]:
    environment = {**os.environ, "PYTHONHASHSEED": hash_seed}
    command = [sys.executable, str(PROGRAM), str(seed)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)


def finish(process: subprocess.Popen[str]) -> dict[str, str]:
    try:
        out, err = process.communicate(timeout=600)
    finally:
        process.kill()
    assert process.returncode == 0, err
    return json.loads(out)


@pytest.mark.proof
def test_every_topic_has_the_same_bytes_in_two_processes_beside_a_busy_one() -> None:
    busy = subprocess.Popen([sys.executable, "-c", "while True: pass"])
    try:
        first, second, other = (finish(each) for each in (start(7, "1"), start(7, "2"), start(8, "1")))
    finally:
        busy.kill()
        busy.wait()
    assert len(first) > 5 and first == second
    noisy = {topic for topic in first if topic.endswith("/scan")}
    assert noisy and all(first[topic] != other[topic] for topic in noisy), "the seed matters"
