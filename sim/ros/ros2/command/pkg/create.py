"""Create a new ROS 2 package."""

from __future__ import annotations

import argparse
import getpass
import re
import shutil
import subprocess
import sys
from pathlib import Path

from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.new_package import license_texts
from gz_course.sim.ros.ros2.new_package.files import BUILD_TYPES, NewPackage

_NAME = re.compile("[a-z][a-z0-9_]*")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package_name", help="The package name")
    parser.add_argument(
        "--package-format", "--package_format", type=int, choices=[2, 3], default=3, help="The package.xml format"
    )
    parser.add_argument("--description", default="TODO: Package description", help="The description in package.xml")
    parser.add_argument(
        "--license",
        default="TODO: License declaration",
        help="The license in package.xml; for some a LICENSE file is made, too ('?' prints the known ones)",
    )
    parser.add_argument("--destination-directory", type=Path, default=Path(), help="Folder of the new package's folder")
    parser.add_argument("--build-type", choices=BUILD_TYPES, default="ament_cmake", help="The build type")
    parser.add_argument("--dependencies", nargs="+", default=[], metavar="PACKAGE", help="Packages it needs")
    parser.add_argument("--maintainer-email", default="", help="Email address of the maintainer")
    parser.add_argument("--maintainer-name", default="", help="Name of the maintainer")
    parser.add_argument("--node-name", default="", help="Name of an executable to begin with")
    parser.add_argument("--library-name", default="", help="Name of a library to begin with")


def main(arguments: argparse.Namespace) -> None:
    if arguments.license == "?":
        print("Supported licenses:", *license_texts.KNOWN, sep="\n")
        return
    _check(arguments)
    folder = arguments.destination_directory / arguments.package_name
    if folder.exists():
        raise CommandError(
            f"The directory already exists: {folder}; remove it, or choose another name or --destination-directory"
        )
    package = _package(arguments)
    _announce(package, arguments)
    try:
        for name in ("", *package.folders()):
            print(f"creating folder {folder / name}")
            (folder / name).mkdir(parents=True, exist_ok=True)
        files = package.files()
        for path, text in files.items():
            target = folder / path
            print(f"creating {target}")
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
    except OSError as error:
        raise CommandError(f"{error.filename} cannot be written: {error.strerror}") from None
    if "LICENSE" not in files:
        known = package.license in license_texts.KNOWN
        what = "The text of the license is not here" if known else f"Unknown license '{package.license}'"
        print(
            f"\n[WARNING]: {what}. It stands in the package.xml, but no LICENSE file has been created. "
            f"It is recommended to use one of these identifiers: {', '.join(license_texts.KNOWN)}"
        )


def _check(arguments: argparse.Namespace) -> None:
    """Raise CommandError if a name cannot be used."""
    named = {"package": arguments.package_name, "node": arguments.node_name, "library": arguments.library_name}
    for kind, word in named.items():
        if (word or kind == "package") and not _NAME.fullmatch(word):
            raise CommandError(
                f"'{word}' cannot be the name of a {kind}; expected small letters, digits and underscores, beginning "
                "with a letter"
            )
    if arguments.package_name == "test":
        raise CommandError("Aborted since 'ament' does not support the package name 'test'; choose another name")


def _package(arguments: argparse.Namespace) -> NewPackage:
    user = arguments.maintainer_name or _user()
    node = arguments.node_name
    if node and node == arguments.library_name:
        node = f"{node}_node"
        _warn("[WARNING] node name can not be equal to the library name")
        _warn(f"[WARNING] renaming node to {node}")
    return NewPackage(
        arguments.package_name,
        arguments.build_type,
        arguments.description,
        arguments.license,
        user,
        arguments.maintainer_email or _email() or f"{user}@todo.todo",
        arguments.dependencies,
        node,
        arguments.library_name,
        arguments.package_format,
    )


def _announce(package: NewPackage, arguments: argparse.Namespace) -> None:
    print("going to create a new package")
    print(f"package name: {package.name}")
    print(f"destination directory: {arguments.destination_directory.resolve()}")
    print(f"package format: {package.format}")
    print("version: 0.0.0")
    print(f"description: {package.description}")
    print(f"maintainer: {[f'{package.maintainer} <{package.email}>']}")
    print(f"licenses: {[package.license]}")
    print(f"build type: {package.build_type}")
    print(f"dependencies: {list(package.dependencies)}")
    for word, name in (("node", package.node), ("library", package.library)):
        if name:
            print(f"{word}_name: {name}")


def _user() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return "user"


def _email() -> str:
    """Return the address that git knows of the user; empty without git."""
    git = shutil.which("git")
    if git is None:
        return ""
    found = subprocess.run([git, "config", "user.email"], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    return found.stdout.strip()


def _warn(sentence: str) -> None:
    print(sentence, file=sys.stderr)
