"""What the doctor tries for real fails when the thing it tries is broken."""

import pytest

from gz_course.grader.tools.doctor.checks import dds, gz_transport, physics, recordings, renderer, sandbox


def test_no_middleware(probes_with, monkeypatch):
    environment = {"RMW_IMPLEMENTATION": "rmw_nobody_has", "ROS_LOG_DIR": "/tmp"}
    monkeypatch.setattr(dds, "ros_environment", lambda domain, folder: environment)
    verdict = dds.examine(probes_with())
    assert verdict.status == "failed" and "no message came" in verdict.seen and verdict.fix


def test_a_message_that_never_comes(probes_with, monkeypatch):
    monkeypatch.setattr(dds, "TALKER", "import sys; sys.stdin.read()")
    verdict = dds.examine(probes_with(1.5))
    assert (verdict.status, "no answer within 1.5 s" in verdict.seen) == ("failed", True), verdict


def test_a_partition_of_its_own_each(probes_with, monkeypatch):
    monkeypatch.setattr(
        gz_transport, "TALKER", "import os; os.environ['GZ_PARTITION'] = 'elsewhere'\n" + gz_transport.TALKER
    )
    verdict = gz_transport.examine(probes_with(2.0))
    assert verdict.status == "failed" and "multicast" in verdict.seen + verdict.fix


def test_an_address_that_is_not_ours(probes_with, monkeypatch):
    monkeypatch.setenv("GZ_IP", "192.0.2.1")
    verdict = gz_transport.examine(probes_with())
    assert (verdict.status, "192.0.2.1" in verdict.seen) == ("warning", True), verdict


def test_a_world_that_does_not_load(probes_with, monkeypatch):
    monkeypatch.setattr(physics, "WORLD", "lidar_rom.sdf")
    verdict = physics.examine(probes_with())
    assert verdict.status == "failed" and "lidar_rom.sdf" in verdict.seen


def test_a_world_that_stands_still(probes_with, monkeypatch):
    monkeypatch.setattr(physics, "STEPS", 0)
    assert physics.examine(probes_with()).status == "failed"


def test_a_recording_that_reads_back_otherwise(probes_with, monkeypatch):
    monkeypatch.setattr(
        recordings, "_CODE", recordings._CODE.replace('"truth/robot/x", value', '"truth/robot/y", value')
    )
    verdict = recordings.examine(probes_with())
    assert (verdict.status, "read []" in verdict.seen) == ("failed", True), verdict


@pytest.mark.parametrize(
    ("code", "status", "word"),
    [
        ("print('')", "warning", "raycast only"),
        ("print('osmesa')", "ok", "osmesa"),
        ("import os; os.kill(os.getpid(), 11)", "warning", "SIGSEGV"),
    ],
)
def test_a_driver_may_be_missing_or_broken(probes_with, monkeypatch, code, status, word):
    monkeypatch.setattr(renderer, "_CODE", code)
    verdict = renderer.examine(probes_with())
    assert (verdict.status, word in verdict.seen) == (status, True), verdict


def test_the_best_sandbox_that_works_is_told(probes_with, monkeypatch):
    told = sandbox.examine(probes_with())
    assert told.seen.startswith("level ") and told.status in ("ok", "warning")
    remembered = []
    monkeypatch.setattr(sandbox, "remember", lambda level, why: remembered.append((level, sorted(why))))
    monkeypatch.setattr(sandbox, "_CODE", "import sys; print('' if sys.argv[1] == 'C' else 'no such thing here')")
    told = sandbox.examine(probes_with())
    assert told.status == "warning" and told.seen.startswith("level C") and "Not A: no such thing here" in told.seen
    assert remembered == [("C", ["A", "B"])]
