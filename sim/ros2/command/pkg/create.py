"""Create a new ROS 2 package."""

from __future__ import annotations

import argparse
import getpass
import re
from pathlib import Path

from gz_course.sim.ros2.errors import CommandError
from gz_course.sim.ros2.new_package import BUILD_TYPES, NewPackage

_NAME = re.compile("[a-z][a-z0-9_]*")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package_name", help="The package name")
    parser.add_argument(
        "--package-format", "--package_format", choices=["3"], default="3", help="The package.xml format"
    )
    parser.add_argument("--description", default="TODO: Package description", help="The description in package.xml")
    parser.add_argument("--license", default="TODO: License declaration", help="The license in package.xml")
    parser.add_argument("--destination-directory", type=Path, default=Path(), help="Folder of the new package's folder")
    parser.add_argument("--build-type", choices=BUILD_TYPES, default="ament_cmake", help="The build type")
    parser.add_argument("--dependencies", nargs="+", default=[], metavar="PACKAGE", help="Packages it needs")
    parser.add_argument("--maintainer-email", default="", help="Email address of the maintainer")
    parser.add_argument("--maintainer-name", default="", help="Name of the maintainer")
    parser.add_argument("--node-name", default="", help="Name of an executable to begin with")


def main(arguments: argparse.Namespace) -> None:
    name = arguments.package_name
    for word, kind in ((name, "package"), (arguments.node_name or "node", "node")):
        if not _NAME.fullmatch(word):
            raise CommandError(
                f"'{word}' cannot be the name of a {kind}; expected small letters, digits and underscores, beginning "
                "with a letter"
            )
    if name == "test":
        raise CommandError("Aborted since 'ament' does not support the package name 'test'; choose another name")
    folder = arguments.destination_directory / name
    if folder.exists():
        raise CommandError(
            f"The directory already exists: {folder}; remove it, or choose another name or --destination-directory"
        )
    user = arguments.maintainer_name or _user()
    package = NewPackage(
        name,
        arguments.build_type,
        arguments.description,
        arguments.license,
        user,
        arguments.maintainer_email or f"{user}@todo.todo",
        arguments.dependencies,
        arguments.node_name,
    )
    print("going to create a new package")
    print(f"package name: {name}")
    print(f"destination directory: {arguments.destination_directory.resolve()}")
    print(f"build type: {package.build_type}")
    print(f"dependencies: {list(package.dependencies)}")
    for path, text in package.files().items():
        target = folder / path
        print(f"creating {target}")
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
        except OSError as error:
            raise CommandError(f"{target} cannot be written: {error.strerror}") from None


def _user() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return "user"
