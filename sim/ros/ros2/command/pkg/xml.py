"""Output the XML of the package manifest or a specific tag."""

from __future__ import annotations

import argparse
from xml.etree import ElementTree

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.packages import package_share


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package_name", help="The package name")
    parser.add_argument("-t", "--tag", help="The XML tag to output, e.g. version")


def main(arguments: argparse.Namespace) -> None:
    path = package_share(arguments.package_name) / "package.xml"
    try:
        text = path.read_text(encoding="utf-8")
        root = ElementTree.fromstring(text)
    except OSError:
        raise CommandError(f"the package {arguments.package_name} has no {path}") from None
    except ElementTree.ParseError as error:
        raise CommandError(f"{path}:{error.position[0]}: this is not XML: {error}") from None
    if arguments.tag is None:
        print(text, end="")
        return
    elements = root.findall(arguments.tag)
    if not elements:
        known = [element.tag for element in root]
        raise CommandError(f"No element <{arguments.tag}> in {path}{did_you_mean(arguments.tag, known)}")
    for element in elements:
        print("".join(element.itertext()).strip())
