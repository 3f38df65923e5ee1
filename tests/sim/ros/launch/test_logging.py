"""Lines on the screen, the log folder and launch.log."""

import io
import os
import re
import subprocess
import sys

import pytest

import gz_course.sim.ros.launch.logging as launch_logging


def test_a_line_has_a_level_and_a_name_and_in_the_file_a_time(capsys, log_folder):
    launch_logging.get_logger("robot").warning("low battery")
    assert capsys.readouterr().out == "[WARNING] [robot]: low battery\n"
    (text,) = (path.read_text() for path in log_folder.glob("*-*/launch.log"))
    assert re.fullmatch(r"\d+\.\d{7} \[WARNING\] \[robot\]: low battery\n", text)


def test_the_environment_changes_the_lines(capsys, log_folder, monkeypatch):
    monkeypatch.setenv("OVERRIDE_LAUNCH_SCREEN_FORMAT", "{levelname:<8}\\t{message}")
    monkeypatch.setenv("OVERRIDE_LAUNCH_LOG_FORMAT", "default_with_timestamp")
    launch_logging.reset()
    launch_logging.get_logger("robot").warning("%d percent", 5)
    assert capsys.readouterr().out == "WARNING \t5 percent\n"
    (text,) = (path.read_text() for path in log_folder.glob("*-*/launch.log"))
    assert re.fullmatch(r"\d+\.\d{7} \[WARNING\] \[robot\]: 5 percent\n", text)


def test_a_format_of_lines_that_means_nothing_is_told(capsys, monkeypatch):
    monkeypatch.setenv("OVERRIDE_LAUNCH_SCREEN_FORMAT", "{nothing}")
    launch_logging.reset()
    launch_logging.get_logger("robot").info("hello")
    seen = capsys.readouterr()
    assert seen.out == "[INFO] [robot]: hello\n"
    assert seen.err.startswith("OVERRIDE_LAUNCH_SCREEN_FORMAT='{nothing}' is no format of log lines")


def test_the_folder_is_named_after_the_time_the_host_and_the_process(log_folder):
    name = os.path.basename(launch_logging.launch_config.log_dir)  # noqa: PTH119
    assert re.fullmatch(rf"\d{{4}}-\d\d-\d\d-\d\d-\d\d-\d\d-\d{{6}}-.+-{os.getpid()}", name)
    assert (log_folder / "latest").resolve().name == name


@pytest.mark.parametrize(
    ("variables", "folder"),
    [({"ROS_LOG_DIR": "{}/a"}, "a"), ({"ROS_HOME": "{}/b"}, "b/log"), ({"HOME": "{}"}, ".ros/log")],
)
def test_where_the_folder_is(tmp_path, monkeypatch, variables, folder):
    for name in ("ROS_LOG_DIR", "ROS_HOME"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value.format(tmp_path))
    assert os.path.dirname(launch_logging.launch_config.log_dir) == str(tmp_path / folder)  # noqa: PTH120


def test_without_a_folder_it_says_so_and_goes_on(tmp_path, monkeypatch, capsys):
    (tmp_path / "file").touch()
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "file"))
    launch_logging.get_logger().info("hello")
    text = capsys.readouterr().out
    assert "[WARNING] [launch]: there will be no log files" in text
    assert text.count("[INFO] [launch]: hello\n") == 1


def test_levels(capsys):
    logger = launch_logging.get_logger("robot")
    logger.debug("nobody sees this")
    launch_logging.launch_config.level = "debug"
    logger.debug("seen")
    assert capsys.readouterr().out == "[DEBUG] [robot]: seen\n"
    with pytest.raises(ValueError, match="no logging level"):
        launch_logging.launch_config.level = "loud"


def test_a_screen_of_another_encoding(monkeypatch):
    screen = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    monkeypatch.setattr(sys, "stdout", screen)
    launch_logging.launch_config.write_to_screen("grün\n")
    assert screen.buffer.getvalue() == b"gr?n\n"


def test_a_reader_that_has_gone_is_no_error(tmp_path):
    code = (
        "import launch.logging\n"
        "log = launch.logging.get_logger()\n"
        "while not launch.logging.launch_config._screen_is_gone: log.info('x')\n"
        "log.info('more')\n"
    )
    done = subprocess.run(
        ["sh", "-c", '"$0" -c "$1" | head -n 1', sys.executable, code],
        env={**os.environ, "ROS_LOG_DIR": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    assert (done.stdout, done.stderr) == ("[INFO] [launch]: x\n", "")
