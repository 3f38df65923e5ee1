"""Fixtures that run launch descriptions in this process and return their output."""

import threading

import pytest

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.ros import launch
from gz_course.sim.ros.launch import LaunchDescription, LaunchService

DEADLINE = 120.0


@pytest.fixture(autouse=True)
def log_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros_log"))
    monkeypatch.delenv("OVERRIDE_LAUNCH_PROCESS_OUTPUT", raising=False)
    launch_logging.reset()
    yield tmp_path / "ros_log"
    launch_logging.reset()


class Result:
    """Exit code and printed lines of a run, without the two lines at the beginning of every run."""

    def __init__(self, code, text):
        self.code = code
        self.text = text
        self.lines = text.splitlines()[2:]

    def printed_by(self, name):
        """Return the lines of processes with this name, without their label."""
        prefix = f"[{name}-"
        return [line.partition("] ")[2] for line in self.lines if line.startswith(prefix)]


@pytest.fixture
def run(capsys):
    """Run actions to the end; the launch is shut down at a deadline."""

    def run(*entities, arguments=None, **options):
        launch_logging.reset()
        service = LaunchService()
        service.context.launch_configurations.update(arguments or {})
        service.include_launch_description(LaunchDescription(list(entities)))
        watchdog = threading.Timer(DEADLINE, service.shutdown)
        watchdog.start()
        try:
            code = service.run(**options)
            assert watchdog.is_alive(), "the launch did not end by itself"
        finally:
            watchdog.cancel()
            watchdog.join()
        return Result(code, capsys.readouterr().out)

    return run


@pytest.fixture
def performed():
    """Return the text of a substitution with these launch configurations."""

    def perform(substitution, **configurations):
        context = launch.LaunchContext()
        context.launch_configurations.update(configurations)
        return context.perform_substitution(substitution)

    return perform
