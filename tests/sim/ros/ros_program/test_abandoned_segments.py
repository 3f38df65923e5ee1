"""Segments of shared memory go if their process has ended, and only then."""

import fcntl
import signal
import subprocess
import sys

import pytest

from gz_course.sim.ros.ros_program.abandoned_segments import FOLDER, remove_abandoned_segments

NODE = """
import rclpy
rclpy.init(domain_id=231)
node = rclpy.create_node("left_behind")
print("ready", flush=True)
rclpy.spin(node)
"""


def test_only_segments_without_an_owner_are_removed(tmp_path):
    dead, alive, unlocked = (f"fastrtps_{digit * 16}" for digit in "0af")
    for name in (dead, dead + "_el", alive, alive + "_el", unlocked, "fastrtps_port7411", "fastrtps_port7411_el"):
        (tmp_path / name).write_bytes(b"12345678" if name in (dead, alive) else b"")
    (tmp_path / f"fastrtps_{'b' * 16}_el").touch()  # of a process that is about to make its segment
    before = {path.name for path in tmp_path.iterdir()}
    with (tmp_path / f"{alive}_el").open() as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        assert remove_abandoned_segments(tmp_path) == 8
    assert before - {path.name for path in tmp_path.iterdir()} == {dead, dead + "_el"}
    assert remove_abandoned_segments(tmp_path) == 8, "its owner has let go"
    assert remove_abandoned_segments(tmp_path / "nowhere") == 0


@pytest.mark.proof
def test_a_killed_node_leaves_nothing_after_the_next_start(monkeypatch):
    for name in ("FASTDDS_BUILTIN_TRANSPORTS", "FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE"):
        monkeypatch.delenv(name, raising=False)
    before = set(FOLDER.iterdir())
    with subprocess.Popen([sys.executable, "-c", NODE], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "ready\n"
        own = {path for path in _mapped(process.pid) if path not in before}
        remove_abandoned_segments()
        assert own and all(path.exists() for path in own), "a live process keeps its segment"
        process.send_signal(signal.SIGKILL)
    assert all(path.exists() for path in own)
    remove_abandoned_segments()
    assert not any(path.exists() for path in own)


def _mapped(pid):
    """Return the segments that a process has mapped."""
    from pathlib import Path

    lines = Path(f"/proc/{pid}/maps").read_text().splitlines()
    paths = {Path(line.split()[-1]) for line in lines if "/dev/shm/fastrtps_" in line}
    return {path for path in paths if "port" not in path.name}
