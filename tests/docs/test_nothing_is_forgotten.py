"""What a full installation has is here, or the page on full installations says that it is not."""

from __future__ import annotations

import importlib
import re
import tomllib
from pathlib import Path

import pytest
from ament_index_python.packages import get_packages_with_prefixes

from gz_course.sim.ros.ros2.command_line import COMMANDS, found

FULL = tomllib.loads((Path(__file__).parent / "full_installation.toml").read_text(encoding="utf-8"))
PAGE = (Path(__file__).parents[2] / "docs" / "full_install.md").read_text(encoding="utf-8")


def absent(text: str) -> set[str]:
    """Return the names that the section lists in backticks."""
    return set(re.findall(r"`([^`]+)`", text))


SECTION = absent(PAGE.partition("## Not here")[2].partition("\n## ")[0])


@pytest.mark.parametrize("module", FULL["names"])
def test_every_name_of_a_launch_file_can_be_imported(module: str) -> None:
    has = importlib.import_module(f"gz_course.sim.ros.{module}")
    assert [name for name in FULL["names"][module].split() if not hasattr(has, name) and name not in SECTION] == []


def test_every_tag_of_a_launch_file_is_on_the_page() -> None:
    assert [
        tag for tag in FULL["launch_files"]["tags"].split() if f"`{tag}`" not in PAGE and f"`<{tag}>`" not in PAGE
    ] == []


@pytest.mark.parametrize("command", FULL["verbs"])
def test_every_verb_is_there(command: str) -> None:
    commands = found(COMMANDS)
    if command not in commands:
        assert f"ros2 {command}" in SECTION
        return
    verbs = found(commands[command]) if commands[command].is_dir() else {}
    wanted = FULL["verbs"][command].split() if verbs else ()
    assert [verb for verb in wanted if verb not in verbs and f"ros2 {command} {verb}" not in SECTION] == []


def test_every_package_is_there() -> None:
    packages = get_packages_with_prefixes()
    assert [name for name in FULL["packages"]["names"].split() if name not in packages and name not in SECTION] == []


def test_nothing_that_is_here_is_listed_as_missing() -> None:
    packages = get_packages_with_prefixes()
    assert sorted(name for name in SECTION if name in packages) == []
