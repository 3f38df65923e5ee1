"""The real ament_cmake is found only where it could build."""

import pytest

from gz_course.sim.ros.ament_cmake.installed_ament_cmake import ament_cmake_is_installed


@pytest.mark.parametrize("cmake", [False, True])
@pytest.mark.parametrize("variable", [None, "AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH"])
def test_it_takes_cmake_and_a_prefix_with_ament_cmake(tmp_path, monkeypatch, cmake, variable):
    config = tmp_path / "ros/share/ament_cmake/cmake/ament_cmakeConfig.cmake"
    config.parent.mkdir(parents=True)
    config.touch()
    program = tmp_path / "bin/cmake"
    program.parent.mkdir()
    if cmake:
        program.touch(0o755)
    monkeypatch.setenv("PATH", str(program.parent))
    for name in ("AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "CMAKE_COMMAND"):
        monkeypatch.delenv(name, raising=False)
    if variable:
        monkeypatch.setenv(variable, f"/nowhere:{tmp_path / 'ros'}")
    assert ament_cmake_is_installed() is (cmake and variable is not None)
