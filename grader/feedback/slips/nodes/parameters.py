"""Mistakes with ROS parameters that raise no error."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Sequence

from gz_course.grader.feedback.facts.ros_parameters import ASKS, declared, listeners, members, objects, owners, reads
from gz_course.grader.feedback.facts.syntax import Place, assigned, calls, functions, last_name, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import Run, slip, slip_of_run
from gz_course.sim.did_you_mean import nearest_name

RESULT = "SetParametersResult"
POST = "add_post_set_parameters_callback"
FIELDS = {float: "double_value", int: "integer_value", str: "string_value", bool: "bool_value"}
NAMES = {float: "a double", int: "an integer", str: "a text", bool: "a truth value"}
CASES = frozenset({"lower", "upper", "capitalize", "title", "casefold"})


@slip
def callbacks_without_result(tree: ast.AST) -> Iterator[Place]:
    """Find a callback for changes of parameters that returns nothing, or a truth value."""
    functions = {node.name: node for node in nodes_of(tree, ast.FunctionDef)}
    for node in nodes_of(tree, ast.Call):
        if not unparse(node.func).endswith("add_on_set_parameters_callback"):
            continue
        name = unparse(node.args[0]).rpartition(".")[2] if node.args else ""
        if name not in functions:
            continue
        returned = [each.value for each in nodes_of(functions[name], ast.Return)]
        if all(value is None or isinstance(value, ast.Constant) for value in returned):
            yield (
                functions[name].lineno,
                f"{name}() is asked whether a parameter may change, and must return SetParametersResult("
                "successful=True) of rcl_interfaces.msg; with another answer, or none, the change is refused",
            )


@slip
def results_that_refuse(tree: ast.AST) -> Iterator[Place]:
    """Find `return SetParametersResult()`, whose field `successful` is False."""
    if ".successful" in unparse(tree):
        return
    for call, name in calls(tree):
        if name == RESULT and not call.args and not any(each.arg in ("successful", None) for each in call.keywords):
            yield (
                call.lineno,
                f"{unparse(call)[:60]} refuses the new value, because its field successful is False: "
                f"{RESULT}(successful=True) accepts it",
            )


@slip
def callbacks_that_nobody_calls(tree: ast.AST) -> Iterator[Place]:
    """Find a function that answers with a SetParametersResult in a file that registers none."""
    if "_set_parameters_callback" in unparse(tree):
        return
    for function in functions(tree):
        if any(name == RESULT for _, name in calls(function)):
            yield (
                function.lineno,
                f"{function.name}() is not called when a parameter changes: "
                f"self.add_on_set_parameters_callback(self.{function.name}) in __init__ registers it",
            )


@slip
def objects_for_values(tree: ast.AST) -> Iterator[Place]:
    """Find `get_parameter('side') == 'left'`, which compares an object with a text and never holds."""
    held = objects(tree)
    for node in walk(tree):
        if isinstance(node, ast.Compare) and isinstance(node.ops[0], ast.Eq | ast.NotEq | ast.In | ast.NotIn):
            pair = (node.left, node.comparators[0])
            for one, other in (pair, pair[::-1]):
                what = _what(one, held)
                if what and _plain(other):
                    never = isinstance(node.ops[0], ast.Eq | ast.In)
                    yield (
                        node.lineno,
                        f"{unparse(node)[:70]} {'never' if never else 'always'} holds: {what}",
                    )
        elif isinstance(node, ast.If | ast.IfExp | ast.While):
            test = node.test.operand if isinstance(node.test, ast.UnaryOp) else node.test
            if what := _what(test, held):
                yield node.test.lineno, f"{unparse(test)[:70]} always counts as true: {what}"


def _what(node: ast.expr, held: set[str]) -> str:
    """Say which object an expression is that is not the value of a parameter; empty if it is none."""
    text = unparse(node)
    if isinstance(node, ast.Call):
        name = last_name(node.func)
        if name in ASKS:
            return f"{name}() returns a Parameter, an object, and its value is {text[:60]}.value"
        if name == "get_parameter_value":
            return (
                "get_parameter_value() returns a message with a field for each type, not the value: "
                "get_parameter(NAME).value is the value"
            )
        if name == "str" and len(node.args) == 1 and _what(node.args[0], held):
            return (
                "str() of a Parameter describes the object, with its name and its type: "
                f"{unparse(node.args[0])[:60]}.value is the value"
            )
    if isinstance(node, ast.Name | ast.Attribute) and text in held:
        return f"{text} is a Parameter, an object, and its value is {text}.value"
    return ""


def _plain(node: ast.expr) -> bool:
    if isinstance(node, ast.Tuple | ast.List | ast.Set):
        return all(_plain(each) for each in node.elts)
    return isinstance(node, ast.Constant) and node.value is not None


@slip
def objects_for_names(tree: ast.AST) -> Iterator[Place]:
    """Find `if parameter == 'distance':` in a callback for changes, where the name of the Parameter is meant."""
    for function in listeners(tree):
        single = members(function)
        whole = {each.arg for each in function.args.args} - {"self"}
        for node in nodes_of(function, ast.Compare):
            left, right = unparse(node.left), node.comparators[0]
            if left in single and isinstance(node.ops[0], ast.Eq | ast.In) and _plain(right):
                yield (
                    node.lineno,
                    f"{unparse(node)[:60]} never holds: {left} is a Parameter, an object with a name and a value; "
                    f"compare {left}.name",
                )
            elif isinstance(node.ops[0], ast.In) and _plain(node.left) and unparse(right) in whole:
                yield (
                    node.lineno,
                    f"{unparse(node)[:60]} never holds: {unparse(right)} is a list of Parameter objects, not "
                    "of names; go through it, and compare the .name of each",
                )


@slip
def fields_of_another_type(tree: ast.AST) -> Iterator[Place]:
    """Find `.integer_value` of a parameter that is a double: only the field of its own type is set."""
    known = declared(tree) or {}
    asked = {id(call): name for call, name in reads(tree)}
    own = {
        function.name
        for function in functions(tree)
        for each in nodes_of(function, ast.Return) if isinstance(each.value, ast.Call)
        and last_name(each.value.func) == "get_parameter_value"
    }  # fmt: skip
    for node in walk(tree):
        match node:
            case (
                ast.Attribute(
                    value=ast.Call(func=ast.Attribute(value=ast.Call() as read, attr="get_parameter_value")), attr=field
                )
                | ast.Attribute(value=ast.Call() as read, attr=field)
            ):
                if read is node.value and last_name(read.func) not in own:
                    continue
                _, default = known.get(asked.get(id(read), ""), (0, None))
                kind = type(default.value) if isinstance(default, ast.Constant) else None
                right = FIELDS.get(kind) if kind is not None else None
                if right and field in FIELDS.values() and field != right:
                    yield (
                        node.lineno,
                        f"{field} of the parameter {asked[id(read)]} is never set, because that is {NAMES[kind]}: "  # type: ignore[index]
                        f"its value is in {right}, or take get_parameter({asked[id(read)]!r}).value",
                    )


@slip
def whole_numbers_of_doubles(tree: ast.AST) -> Iterator[Place]:
    """Find `int(self.get_parameter('distance').value)` of a parameter whose default is not a whole number."""
    values = _values(tree, float)
    for call, name in calls(tree):
        given = unparse(call.args[0]) if name in ("int", "round") and len(call.args) == 1 else ""
        default = values.get(given)
        if isinstance(default, float) and default != int(default):
            cut = int(default) if name == "int" else round(default)
            yield (
                call.lineno,
                f"{unparse(call)[:60]} makes a whole number of a parameter, {cut} of {default:g}: leave the "
                "value as it is",
            )


@slip
def texts_for_truth(tree: ast.AST) -> Iterator[Place]:
    """Find `1 if side else -1` where side is a text, which counts as true whatever it says."""
    values = _values(tree, str)
    for node in nodes_of(tree, ast.If, ast.IfExp, ast.While):
        test = node.test.operand if isinstance(node.test, ast.UnaryOp) else node.test
        default = values.get(unparse(test))
        if default:
            yield (
                node.test.lineno,
                f"{unparse(test)[:60]} is a text and counts as true whatever it says: compare it, == {default!r}",
            )


def _values(tree: ast.AST, kind: type) -> dict[str, object]:
    """Return the default of each parameter of a type, by the expressions and names that hold the value."""
    found: dict[str, object] = {}
    asked = {id(call): name for call, name in reads(tree)}
    defaults = {
        name: default.value
        for name, (_, default) in (declared(tree) or {}).items()
        if isinstance(default, ast.Constant) and type(default.value) is kind
    }
    for node in nodes_of(tree, ast.Attribute):
        if node.attr == "value" and asked.get(id(node.value), "") in defaults:
            found[unparse(node)] = defaults[asked[id(node.value)]]
    held: dict[str, list[object]] = {}
    for target, value in assigned(tree):
        held.setdefault(unparse(target), []).append(found.get(unparse(value)))
    found.update({name: given[0] for name, given in held.items() if given[0] is not None and None not in given})
    return found


@slip
def other_spelling(tree: ast.AST) -> Iterator[Place]:
    """Find `side == 'Left'` where the value of the parameter is 'left', and nothing changes capitals."""
    values = {
        default.value: name
        for name, (_, default) in (declared(tree) or {}).items()
        if isinstance(default, ast.Constant) and isinstance(default.value, str) and default.value
    }
    if any(name in CASES for _, name in calls(tree)):
        return
    texts = [
        (node, other.value)
        for node in nodes_of(tree, ast.Compare)
        for other in (node.left, *node.comparators)
        if isinstance(other, ast.Constant) and isinstance(other.value, str)
    ]
    for node, text in texts:
        for value, name in values.items():
            same = text.strip().lower() == value.strip().lower()
            if same and text != value and all(each != value for _, each in texts):
                yield (
                    node.lineno,
                    f"{unparse(node)[:60]} never holds: the parameter {name} can be {value!r}, and {text!r} is "
                    "another text: capitals and spaces count",
                )


@slip
def read_as_it_was(tree: ast.Module) -> Iterator[Place]:
    """Find get_parameter() in the callback for changes, kept in an attribute: it still returns the old value."""
    inside, heard = owners(tree), {function.name: function for function in listeners(tree)}
    for function in heard.values():
        if any(last_name(call.args[0]) == function.name for call, name in calls(tree) if name == POST and call.args):
            continue
        names = {function.name} | {name for _, name in calls(function)}
        for node in nodes_of(tree, ast.Assign):
            if inside[id(node)] not in names - {"__init__"}:
                continue
            kept = unparse(node.targets[0])
            old = [call for call, _ in reads(node) if last_name(call.func) in ASKS]
            others = {inside[id(each)] for each in _keeping(tree, kept)} - names - {"__init__"}
            if kept.startswith("self.") and old and not others:
                way = "" if inside[id(node)] == function.name else f", which calls {inside[id(node)]}(),"
                yield (
                    node.lineno,
                    f"{unparse(node)[:70]} keeps the old value: {function.name}(){way} is called before the new "
                    "value is set, so get_parameter() still returns the one before; take the new one from the argument "
                    f"of {function.name}()",
                )
                return


@slip
def whatever_is_set(tree: ast.AST) -> Iterator[Place]:
    """Find a callback for changes that takes the value of any parameter for that of one."""
    known = set(declared(tree) or {})
    for function in listeners(tree):
        single, whole = members(function), {each.arg for each in function.args.args} - {"self"}
        takes = [
            node
            for node in nodes_of(function, ast.Assign) if unparse(node.targets[0]).startswith("self.")
            and re.fullmatch(r"(\w+)(\[0\])?\.value", unparse(node.value))
            and re.match(r"\w+", unparse(node.value))[0] in single | whole  # type: ignore[index]
        ]  # fmt: skip
        code = unparse(function)
        seen: dict[str, ast.Assign] = {}
        for node in takes:
            if (first := seen.setdefault(unparse(node.targets[0]), node)) is not node and ".name" in code:
                yield (
                    node.lineno,
                    f"{unparse(node)[:60]} puts the value of another parameter into what line {first.lineno} "
                    "sets: each parameter needs an attribute of its own",
                )
        if takes and len(known) > 1 and ".name" not in code and "continue" not in code:
            yield takes[0].lineno, _any(unparse(takes[0]), sorted(known))
            continue
        for test in nodes_of(function, ast.If):
            excluded, last = _chain(test)
            left = sorted(known - excluded)
            other = next((each for each in takes if any(each is node for node in last)), None)
            above = any(each is not test and test in each.orelse for each in nodes_of(function, ast.If))
            if (
                other is not None
                and excluded
                and len(left) > 1
                and not above
                and not re.search("continue|return", code.rpartition("return")[0])
            ):
                yield other.lineno, _any(unparse(other), left)
                break


@slip
def set_over_what_is_given(tree: ast.Module) -> Iterator[Place]:
    """Find a node that sets a parameter of its own in __init__ to the default that it has declared."""
    inside, known = owners(tree), declared(tree) or {}
    for call, name in calls(tree):
        if name != "set_parameters" or inside[id(call)] != "__init__" or not unparse(call.func).startswith("self."):
            continue
        for each in (node for node in nodes_of(call, ast.Call) if last_name(node.func) == "Parameter"):
            first = each.args[0].value if each.args and isinstance(each.args[0], ast.Constant) else None
            given = [*each.args[2:], *(one.value for one in each.keywords if one.arg == "value")]
            if first in known and given and isinstance(given[0], ast.Constant):
                yield (
                    call.lineno,
                    f"{unparse(each)[:60]} replaces the value that the node was started with: declare_parameter() "
                    f"has taken that for {first} already, so remove it",
                )
                return


def _any(code: str, names: Sequence[str]) -> str:
    return (
        f"{code[:60]} takes the new value of {' and of '.join(names)} alike, whichever was set: ask for the .name of "
        "each first"
    )


def _chain(test: ast.If) -> tuple[set[str], list[ast.stmt]]:
    """Return the names that a chain of if and elif asks for, and the statements of its else."""
    names: set[str] = set()
    while True:
        if isinstance(test.test, ast.Compare) and last_name(test.test.left) == "name":
            names |= {str(each.value) for each in nodes_of(test.test.comparators[0], ast.Constant)}
        if len(test.orelse) != 1 or not isinstance(test.orelse[0], ast.If):
            return names, test.orelse
        test = test.orelse[0]


def _keeping(tree: ast.AST, name: str) -> Iterator[ast.Assign]:
    """Yield each assignment to a name."""
    for node in nodes_of(tree, ast.Assign):
        if name in [unparse(each) for each in node.targets]:
            yield node


@slip_of_run
def declared_otherwise(tree: ast.AST, run: Run) -> Iterator[Place]:
    """Find a parameter of the exercise that is declared under another name, and so never gets its value."""
    known = declared(tree) or {}
    others = [name for name in known if name not in run.names]
    for name in run.names:
        if name in known or not others:
            continue
        near = nearest_name(name, others) or next((each for each in others if name in each or each in name), "")
        if near:
            yield (
                known[near][0],
                f"the parameter {near} is declared here, and the task calls it {name}: under another name a node "
                "does not get the value that is given",
            )
