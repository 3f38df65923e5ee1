"""The program `launch_test`: runs the launch tests of a file.

Exit codes are those of ROS 2: 0 if all tests pass, 1 if one fails, 2 for wrong usage or a file that cannot be loaded.
"""

from __future__ import annotations

import argparse
import importlib.util
import sys
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.errors import sentence
from gz_course.sim.ros.launch.launch_introspector import arguments_text
from gz_course.sim.ros.launch_testing.junitxml import unittestResultsToXml
from gz_course.sim.ros.launch_testing.loader import LoadTestsFromPythonModule
from gz_course.sim.ros.launch_testing.test_runner import LaunchTestRunner
from gz_course.sim.terminal_text import guard


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("launch_test_file", help="Path to the launch test")
    parser.add_argument("--package-name", help="Name of the package the test is in, for the xUnit report")
    parser.add_argument("-v", "--verbose", action="store_true", help="Log what happens in detail")
    parser.add_argument(
        "-s", "--show-args", "--show-arguments", dest="show_args", action="store_true",
        help="Show the arguments of the launch test instead of running it",
    )  # fmt: skip
    parser.add_argument(
        "launch_arguments", nargs="*", help="Arguments in '<name>:=<value>' format (for duplicates, last one wins)"
    )
    parser.add_argument("--junit-xml", dest="xmlpath", metavar="FILE", help="Write an xUnit report to this file")


def run(
    parser: argparse.ArgumentParser,
    args: argparse.Namespace,
    test_runner_cls: type[LaunchTestRunner] = LaunchTestRunner,
) -> int:
    """Run the tests of a file; return the exit code. Ends by `parser.error` if the file cannot be loaded."""
    path = Path(args.launch_test_file)
    if not path.is_file():
        names = [each.name for each in path.parent.iterdir()] if path.parent.is_dir() else []
        parser.error(f"Test file '{path}' does not exist{did_you_mean(path.name, names)}")
    package = args.package_name or path.stem
    try:
        module = _module_of(path.resolve(), package)
        if not hasattr(module, "generate_test_description"):
            parser.error(f"{path}: it defines no generate_test_description(), which makes a file a launch test")
        runs = LoadTestsFromPythonModule(module, name=f"{package}.{path.stem}.launch_tests")
        runner = test_runner_cls(runs, args.launch_arguments, args.verbose)
        runner.validate()
        if args.show_args:
            print(arguments_text(runs[0].get_launch_description()))
            return 0
        results = runner.run()
    except Exception as error:
        parser.error(sentence(error))
    if args.xmlpath:
        report = unittestResultsToXml(name=f"{package}.{path.stem}", test_results=results)
        report.write(args.xmlpath, encoding="utf-8", xml_declaration=True)
    return 0 if all(result.wasSuccessful() for result in results.values()) else 1


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `launch_test`; the program imports this module by its public name, so an installed one comes first."""
    guard()
    parser = argparse.ArgumentParser(prog="launch_test", description="Launch integration testing tool.")
    add_arguments(parser)
    return run(parser, parser.parse_args(arguments))


def _module_of(path: Path, name: str) -> ModuleType:
    """Return the module in a file, under a name that pickling and unittest find it by."""
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise ImportError(f"'{path}' is no file of Python; the name of a launch test ends with .py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


if __name__ == "__main__":
    sys.exit(main())
