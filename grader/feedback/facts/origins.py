"""The lines of a file that make what a node publishes or logs, and the conditions that stand before it.

A student who is told that a value is wrong looks for the lines that make it. A kind of submission that is Python
records them as facts of a run; the diagnosis names them if nothing better is known.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass, field

from gz_course.grader.feedback.facts.syntax import Places, kept, nodes_of, parents, places_in, unparse, walk

SENDS = frozenset({"publish", "publish_feedback", "sendTransform"})
LOGS = frozenset({"debug", "info", "warn", "warning", "error"})
MOST = 4  # lines that are named; more do not show where to look
MOST_SENDS = 20  # calls of publish(), and conditions before each, that are looked at
LONGEST = 70  # characters of a line that are quoted
PLAIN = frozenset({"append", "get_logger", "now", "get_clock", "to_msg", "list", "tuple", "enumerate", "len", "range"})

LEAVES = ast.Return | ast.Continue | ast.Break | ast.Raise
Function = ast.FunctionDef | ast.AsyncFunctionDef
Name = tuple[int, str]  # function, 0 for attributes of self and for the module; and what is assigned there


def origins(content: bytes) -> Places:
    """Return `line` and `code` of the calculations behind all that is published; nothing if there are more than `MOST`.

    Without a publisher, what is logged counts.
    """
    return places_in(content, lambda tree: _origins(_program(tree)))


def conditions(content: bytes) -> Places:
    """Return what stands before a publish() in its function, and before the calls of that function, from above.

    Each place has `line` and `code`, such as `if not hits: return`; `sends` is the line of the publish() and `topic`
    where it publishes, which is empty if that is no constant of the file.
    """
    return places_in(content, lambda tree: _conditions(_program(tree)))


def before_speeds(content: bytes) -> Places:
    """Return `line` and `code` of the conditions that stand before a linear.x is set to what is no constant."""
    return places_in(content, lambda tree: _before_speeds(_program(tree)))


def of_the_drive(content: bytes) -> Places:
    """Return `line` and `code` of the conditions on which a linear.x other than 0 is sent; a start is none of them."""
    return places_in(content, lambda tree: _of_the_drive(_program(tree)))


@dataclass
class _Program:
    """The functions of a file, and what each statement assigns."""

    tree: ast.Module
    functions: dict[str, Function] = field(default_factory=dict)
    owner: dict[ast.AST, Function] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for node in walk(self.tree):
            if isinstance(node, Function):
                self.functions[node.name] = node
        self.parent = parents(self.tree)
        for node in self.parent:
            above = self.parent.get(node)
            while above is not None and not isinstance(above, Function):
                above = self.parent.get(above)
            if above is not None:
                self.owner[node] = above

    def name(self, node: ast.AST) -> Name | None:
        """Return the variable that an expression such as `a`, `a.x[0]` or `self.a.x` reads or changes."""
        while isinstance(node, ast.Attribute | ast.Subscript | ast.Starred):
            above = node.value
            if isinstance(node, ast.Attribute) and isinstance(above, ast.Name) and above.id == "self":
                return 0, f"self.{node.attr}"
            node = above
        if not isinstance(node, ast.Name) or node.id == "self":
            return None
        owner = self.owner.get(node)
        return (id(owner) if owner is not None else 0), node.id

    def read(self, node: ast.AST) -> set[Name]:
        """Return the variables that an expression reads, those of the module also."""
        parts = [each for each in nodes_of(node, ast.Name, ast.Attribute)]
        found = {name for part in parts if (name := self.name(part)) is not None}
        return found | {(0, word) for _, word in found}

    def changes(self) -> Iterator[tuple[ast.stmt, set[Name], ast.AST]]:
        """Yield each statement that assigns something, what it assigns, and the expression that it takes it from."""
        for node in walk(self.tree):
            targets: list[ast.expr] = []
            value: ast.AST | None = getattr(node, "value", None)
            if isinstance(node, ast.Assign):
                targets = node.targets
            elif isinstance(node, ast.AugAssign | ast.AnnAssign):
                targets = [node.target]
            elif isinstance(node, ast.For):
                targets, value = [node.target], node.iter
            elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
                method = node.value.func  # such as values.append(x)
                if isinstance(method, ast.Attribute) and node.value.args and method.attr not in SENDS | LOGS:
                    targets = [method.value]
            if targets and value is not None and isinstance(node, ast.stmt):
                parts = [part for each in targets for part in _parts(each)]
                yield node, {name for part in parts if (name := self.name(part)) is not None}, value

    def handed_over(self) -> Iterator[tuple[ast.AST, set[Name], ast.AST]]:
        """Yield each argument of a call of the file's functions, with the parameter that it becomes."""
        for call in nodes_of(self.tree, ast.Call):
            function = self.functions.get(unparse(call.func).rpartition(".")[2])
            names = [each.arg for each in function.args.args if each.arg != "self"] if function is not None else []
            given = [*zip(names, call.args, strict=False), *((each.arg, each.value) for each in call.keywords)]
            yield from ((call, {(id(function), name)}, value) for name, value in given if name in names)


@kept
def _program(tree: ast.Module) -> _Program:
    return _Program(tree)


def _parts(target: ast.expr) -> Iterator[ast.expr]:
    """Yield the targets of an assignment, those of `a, b = ...` one by one."""
    if isinstance(target, ast.Tuple | ast.List):
        for each in target.elts:
            yield from _parts(each)
    else:
        yield target


def _sinks(program: _Program) -> list[ast.Call]:
    """Return the calls that publish; if there are none, those that log."""
    calls = [node for node in nodes_of(program.tree, ast.Call)]
    sends = [call for call in calls if isinstance(call.func, ast.Attribute) and call.func.attr in SENDS and call.args]
    if sends:
        return sends
    return [
        call
        for call in calls
        if isinstance(call.func, ast.Attribute) and call.func.attr in LOGS and "log" in unparse(call.func.value)
    ]


def _origins(program: _Program) -> Places:
    """Follow variables backwards from what is published, through assignments and functions of the file."""
    wanted: set[Name] = set()
    seen: dict[int, ast.AST] = {}
    todo: list[ast.AST] = [argument for call in _sinks(program) for argument in call.args]
    changes = list(program.changes())
    handed_over = list(program.handed_over())
    while todo:
        node = todo.pop()
        if id(node) in seen:
            continue
        seen[id(node)] = node
        wanted |= program.read(node)
        for call in nodes_of(node, ast.Call):
            function = program.functions.get(unparse(call.func).rpartition(".")[2])
            if function is not None:
                returns = [each for each in nodes_of(function, ast.Return)]
                todo += [each.value for each in returns if each.value is not None]
        for statement, names, value in (*changes, *handed_over):
            if names & wanted and id(value) not in seen:
                todo.append(value)
                todo += [test for test, _ in _tests(program, statement)]
    lines = {
        node.lineno: _line(program, node)
        for node in seen.values()
        if isinstance(node, ast.expr) and _tells(program, node)
    }
    return [{"line": line, "code": code} for line, code in sorted(lines.items())] if len(lines) <= MOST else []


def _tells(program: _Program, node: ast.AST) -> bool:
    """Return whether an expression calculates or chooses something; functions of the file are followed, not named."""
    for each in walk(node):
        if isinstance(each, ast.BinOp | ast.BoolOp | ast.USub | ast.Slice | ast.IfExp | ast.ListComp):
            return True
        if isinstance(each, ast.Compare) and not isinstance(each.ops[0], ast.Is | ast.IsNot):
            return True
        if isinstance(each, ast.Constant) and isinstance(each.value, float) and each.value:
            return True
        if isinstance(each, ast.Subscript) and isinstance(each.slice, ast.Constant):
            return True
        if isinstance(each, ast.Call) and each.args:
            name = unparse(each.func).rpartition(".")[2]
            own = name in PLAIN or name in program.functions or name.startswith("create_")
            if name[:1].islower() and not own:
                return True
    return False


def _line(program: _Program, node: ast.AST) -> str:
    """Return the statement around an expression as one line of code, without its block."""
    above: ast.AST | None = node
    while above is not None and not isinstance(above, ast.stmt):
        above = program.parent.get(above)
    return _short(unparse(above if above is not None else node).splitlines()[0])


def _short(code: str) -> str:
    return code if len(code) <= LONGEST else f"{code[: LONGEST - 3]}..."


def _tests(program: _Program, node: ast.AST) -> Iterator[tuple[ast.expr, str]]:
    """Yield the conditions that stand before a statement in its function, from within, and how each is written."""
    while (above := program.parent.get(node)) is not None and not isinstance(node, Function):
        if isinstance(above, ast.If | ast.While) and node is not above.test:
            yield above.test, "else of if {}:" if node in above.orelse else f"{type(above).__name__.lower()} {{}}:"
        for name in ("body", "orelse", "finalbody"):
            block = getattr(above, name, None)
            if isinstance(block, list) and node in block:
                for before in reversed(block[: block.index(node)]):
                    if isinstance(before, ast.If) and not before.orelse and isinstance(before.body[-1], LEAVES):
                        yield before.test, f"if {{}}: {unparse(before.body[-1])}"
        node = above


def _conditions(program: _Program) -> Places:
    places: dict[tuple[int, int], dict[str, object]] = {}
    topics, callers = _topics(program), _callers(program)
    for call in _sinks(program)[:MOST_SENDS]:
        function = program.owner.get(call)
        before = [call, *(callers.get(function.name, []) if function is not None else [])]
        publisher = unparse(call.func.value) if isinstance(call.func, ast.Attribute) else ""
        for test, form in [pair for place in before for pair in _tests(program, place)][:MOST_SENDS]:
            code = unparse(test)
            if "__name__" not in code and "rclpy.ok" not in code:
                said = {"line": test.lineno, "code": _short(form.format(code))}
                places[call.lineno, test.lineno] = said | {"sends": call.lineno, "topic": topics.get(publisher, "")}
    return [places[key] for key in sorted(places)][: 2 * MOST]


def _of_the_drive(program: _Program) -> Places:
    found = {}
    for node in nodes_of(program.tree, ast.Assign):
        if isinstance(node.value, ast.Constant) and node.value.value == 0:
            continue
        if any(unparse(target).endswith("linear.x") for target in node.targets):
            for test, form in _tests(program, node):
                code = unparse(test)
                if "is None" not in code and "__name__" not in code:
                    found[test.lineno] = {"line": test.lineno, "code": _short(form.format(code))}
    return [found[line] for line in sorted(found)][:MOST]


def _before_speeds(program: _Program) -> Places:
    found = {}
    for node in nodes_of(program.tree, ast.Assign):
        if isinstance(node.value, ast.Constant):
            continue
        if any(unparse(target).endswith("linear.x") for target in node.targets):
            for test, form in _tests(program, node):
                found[test.lineno] = {"line": test.lineno, "code": _short(form.format(unparse(test)))}
    return [found[line] for line in sorted(found)][:MOST]


def _callers(program: _Program) -> dict[str, list[ast.Call]]:
    """Return the calls of each function of the file, by its name; callbacks have none."""
    found: dict[str, list[ast.Call]] = {}
    for call in nodes_of(program.tree, ast.Call):
        name = unparse(call.func).removeprefix("self.")
        if name in program.functions and len(found.setdefault(name, [])) < MOST:
            found[name].append(call)
    return found


def _topics(program: _Program) -> dict[str, str]:
    """Return the topic of each publisher that is made with a constant name."""
    found: dict[str, str] = {}
    for node in nodes_of(program.tree, ast.Assign):
        if isinstance(node.value, ast.Call) and len(node.value.args) >= 2:
            topic = node.value.args[1]
            if unparse(node.value.func).endswith("create_publisher") and isinstance(topic, ast.Constant):
                found |= {unparse(target): f"/{str(topic.value).lstrip('/')}" for target in node.targets}
    return found
