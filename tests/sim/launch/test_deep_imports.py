"""Names are found in the modules in which ROS 2's launch and launch_ros have them."""

import ast
import importlib
import pkgutil
import re
from pathlib import Path

import launch
import launch_ros
import launch_ros.event_handlers
import launch_ros.events
import pytest

# Modules that hold names of another spelling than their own.
OF_ITS_OWN_NAME = {
    "boolean_substitution": "NotSubstitution",
    "shutdown_action": "Shutdown",
    "matchers": "matches_action",
    "process_matchers": "matches_pid",
    "process_io": "ProcessIO",
    "on_process_io": "OnProcessIO",
    "python_launch_file_utilities": "get_launch_description_from_python_launch_file",
    "any_launch_file_utilities": "get_launch_description_from_any_launch_file",
    "evaluate_condition_expression_impl": "evaluate_condition_expression",
    "push_ros_namespace": "PushRosNamespace",
}
# What these packages have in modules of several classes only, or outside of ROS 2's layout.
PACKAGES = [
    "launch.actions",
    "launch.substitutions",
    "launch.conditions",
    "launch.event_handlers",
    "launch.events",
    "launch.events.process",
    "launch.launch_description_sources",
    "launch_ros.actions",
    "launch_ros.event_handlers",
]


def snake(name):
    return re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()


def exported():
    for package in PACKAGES:
        module = importlib.import_module(package)
        for name in getattr(module, "__all__", ["OnStateTransition"]):
            if isinstance(getattr(module, name), type):
                yield package, name


FILES = {snake(name): file for file, name in OF_ITS_OWN_NAME.items() if name[0].isupper()}
TOGETHER = {
    **dict.fromkeys(
        ("AllSubstitution", "AndSubstitution", "AnySubstitution", "OrSubstitution"), "boolean_substitution"
    ),
    "ProcessIO": "process_io",
    "OnProcessIO": "on_process_io",
    "InvalidPythonLaunchFileError": "python_launch_file_utilities",
    "InvalidConditionExpressionError": "evaluate_condition_expression_impl",
    "PushROSNamespace": "push_ros_namespace",
    "PushRosNamespace": "push_ros_namespace",
}


@pytest.mark.parametrize(("package", "name"), list(exported()))
def test_every_class_is_in_a_module_of_its_name(package, name):
    if name == "InvalidLaunchFileError":
        package, file = "launch", "invalid_launch_file_error"
    elif (package, name) == ("launch.events", "Shutdown"):
        file = "shutdown"
    else:
        file = TOGETHER.get(name) or FILES.get(snake(name)) or snake(name)
    module = importlib.import_module(f"{package}.{file}")
    assert getattr(module, name) is getattr(importlib.import_module(package), name)


@pytest.mark.parametrize("name", [name for name in launch.__all__ if name[0].isupper() and "_types" not in name])
def test_the_names_of_launch_itself(name):
    module = importlib.import_module(f"launch.{snake(name)}")
    assert getattr(module, name) is getattr(launch, name)


def modules(package):
    for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
        yield found.name


@pytest.mark.parametrize("name", [*modules(launch), *modules(launch_ros)])
def test_a_module_of_another_name_only_passes_on(name):
    module = importlib.import_module(name)
    tree = ast.parse(Path(module.__file__).read_text())
    kinds = {type(node) for node in tree.body}
    if "in the module where" in (ast.get_docstring(tree) or ""):
        assert kinds <= {ast.Expr, ast.ImportFrom, ast.Assign}
    else:
        assert kinds & {ast.ClassDef, ast.FunctionDef} or hasattr(module, "__path__"), "this module has no content"


@pytest.mark.parametrize(
    "statement",
    [
        "import launch.actions; launch.actions.LogInfo",
        "import launch; launch.actions.LogInfo, launch.substitutions.Command, launch.events.process.ProcessExited",
        "import launch; launch.conditions.IfCondition, launch.event_handlers.OnShutdown, launch.logging.get_logger",
        "import launch; launch.launch_description_sources.PythonLaunchDescriptionSource, launch.launch_context",
        "import launch_ros; launch_ros.actions.Node, launch_ros.substitutions.FindPackageShare",
        "import launch_ros; launch_ros.descriptions.ComposableNode, launch_ros.parameter_descriptions.ParameterValue",
        "from launch_ros.events.lifecycle import ChangeState; from launch_ros.event_handlers import OnStateTransition",
        "from launch import LaunchDescription, LaunchContext, Substitution, SomeSubstitutionsType",
    ],
)
def test_styles_of_import(statement):
    exec(statement, {})
