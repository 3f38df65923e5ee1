"""Names are in the same modules as in ROS 2's launch and launch_ros."""

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

# Modules whose public classes have other names than the module, as in ROS 2's launch and launch_ros.
SEVERAL = {
    "launch.actions.shutdown_action": {"Shutdown"},
    "launch.conditions.evaluate_condition_expression_impl": {"InvalidConditionExpressionError"},
    "launch.launch_description_sources.python_launch_file_utilities": {"InvalidPythonLaunchFileError"},
    "launch.substitutions.boolean_substitution": {
        "AllSubstitution",
        "AndSubstitution",
        "AnySubstitution",
        "NotSubstitution",
        "OrSubstitution",
    },
    "launch.logging": {"LaunchConfig"},
    "launch.frontend.parser": {"InvalidFrontendLaunchFileError"},
    "launch_ros.parameter_descriptions": {"Parameter", "ParameterFile", "ParameterValue"},
    "launch_ros.substitutions.find_package": {"FindPackagePrefix", "FindPackageShare"},
}
# Modules that exist only in these packages.
OWN = {
    "launch.errors": {
        "InvalidArgumentError",
        "LaunchError",
        "MissingArgumentError",
        "NotAvailableError",
        "NotTextError",
        "UsedTwiceError",
    },
    "launch.frontend.entity": {"EntityError", "LaunchText"},
    "launch_ros.parameter_values": {"ParameterTypeError", "TypedValue"},
    "launch_ros.ros_adapters": {"ROSAdapter"},  # the module of this name in ROS 2's launch_ros
}
# Modules of ROS 2's launch that hold a type, not a class.
ALIASES = {
    "launch.some_entities_type": "SomeEntitiesType",
    "launch.some_substitutions_type": "SomeSubstitutionsType",
    "launch_ros.parameters_type": "SomeParameters",
    "launch_ros.remap_rule_type": "SomeRemapRules",
}


def snake(name):
    return re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()


def modules():
    """Yield the name below that of the package (`launch.actions.log_info`), and the module."""
    for name, package in (("launch", launch), ("launch_ros", launch_ros)):
        yield name, package
        for found in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            yield name + found.name.removeprefix(package.__name__), importlib.import_module(found.name)


def source(module):
    return Path(module.__file__).read_text()


def defined(module, *kinds):
    return {node.name for node in ast.parse(source(module)).body if isinstance(node, kinds)}


def test_every_public_class_is_in_the_module_of_its_name():
    misplaced = {
        f"{name}.{defined_name}"
        for name, module in modules()
        for defined_name in defined(module, ast.ClassDef)
        if not defined_name.startswith("_")
        and snake(defined_name) != name.rpartition(".")[2]
        and defined_name not in {**SEVERAL, **OWN}.get(name, ())
    }
    assert misplaced == set()


def test_every_name_that_a_package_exports_is_in_it():
    assert not [
        (name, exported)
        for name, module in modules()
        for exported in getattr(module, "__all__", ())
        if not hasattr(module, exported)
    ]


def test_no_module_only_forwards_to_another():
    forwarding = {
        name
        for name, module in modules()
        if not hasattr(module, "__path__")
        and not defined(module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
        and f"\n{ALIASES.get(name)} = " not in source(module)
    }
    assert forwarding == set()


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
        "from launch_ros.events.matchers import matches_node_name",
        "from launch import LaunchDescription, LaunchContext, Substitution, SomeSubstitutionsType",
        "from launch.some_substitutions_type import SomeSubstitutionsType",
        "from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions",
        "from launch.actions.shutdown_action import Shutdown",
        "from launch.actions.append_environment_variable import AppendEnvironmentVariable",
        "from launch.events.process.process_matchers import matches_pid",
        "from launch.utilities.type_utils import normalize_typed_substitution, perform_typed_substitution",
        "from launch.utilities import ensure_argument_type, is_a, is_a_subclass, create_future",
        "from launch.event_handlers.event_named import event_named",
        "from launch.frontend import Entity, Parser, expose_action, expose_substitution",
        "from launch_xml.launch_description_sources import XMLLaunchDescriptionSource",
        "from launch_yaml.launch_description_sources import YAMLLaunchDescriptionSource",
        "from launch_ros.utilities import evaluate_parameters, normalize_parameters, normalize_remap_rules",
        "from launch_ros.parameters_type import SomeParameters, SomeParametersDict, ParameterFile",
        "from launch_ros.remap_rule_type import SomeRemapRules",
        "from launch_ros.ros_adapters import get_ros_node, get_ros_adapter",
        "from launch_ros.actions import LifecycleTransition, RosTimer, SetROSLogDir",
        "import launch_testing; launch_testing.actions.ReadyToTest, launch_testing.asserts.assertInStdout",
        "import launch_testing; launch_testing.post_shutdown_test, launch_testing.parametrize, launch_testing.util",
        "from launch_testing.util import KeepAliveProc; from launch_testing.markers import retry_on_failure",
        "from launch_testing.tools import basic_output_filter; from launch_testing.tools.text import build_text_match",
        "from launch_testing_ros import WaitForTopics; from launch_testing_ros.tools import basic_output_filter",
        "import launch_pytest; launch_pytest.fixture; from launch_pytest.tools import process; launch_pytest.actions",
        "from launch_ros.actions.lifecycle_node import LifecycleNode",
        "from launch.launch_description_sources.any_launch_file_utilities import "
        "get_launch_description_from_any_launch_file",
    ],
)
def test_styles_of_import(statement):
    exec(statement, {})


def test_parameters_and_namespaces_as_actions_of_ones_own_want_them():
    from launch_ros import utilities
    from launch_ros.descriptions import Parameter

    context = launch.LaunchContext()
    text = launch.substitutions.TextSubstitution(text="5")
    found = utilities.evaluate_parameters(context, [{"a": {"b": text}}, Parameter("c", 1), "/x.yaml"])
    assert found == ({"a.b": 5}, {"c": 1}, Path("/x.yaml"))
    assert [utilities.prefix_namespace("/a", name) for name in ("b", "/b", "", None)] == ["/a/b", "/b", "/a", "/a"]
    assert utilities.make_namespace_absolute("a") == "/a" and utilities.is_root_namespace("/")
    assert len(utilities.normalize_remap_rules([("a", "b")])) == 1


def test_a_typed_value_is_what_it_says():
    from launch.utilities.type_utils import coerce_to_type, normalize_typed_substitution, perform_typed_substitution

    context = launch.LaunchContext()
    text = launch.substitutions.TextSubstitution(text="5")
    for value, kind, result in [
        (text, int, 5),
        (["1", text], float, 15.0),
        (True, bool, True),
        ([1, [text]], list[int], [1, 5]),
        ([1, 2.5], list[float], [1.0, 2.5]),
        (text, None, 5),
    ]:
        assert perform_typed_substitution(context, normalize_typed_substitution(value, kind), kind) == result
    for value, kind in (("5", int), ([1], int), (3, None.__class__)):
        with pytest.raises((TypeError, ValueError)):
            normalize_typed_substitution(value, kind)
    assert coerce_to_type("$(var x)", float, can_be_str=True) == "$(var x)"
    with pytest.raises(ValueError, match="is not true or false"):
        coerce_to_type("5", bool)
