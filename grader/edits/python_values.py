"""Edits of expressions in a Python file that could mend it: what a person would try who has the file and the task."""

from __future__ import annotations

import ast
import itertools
from collections.abc import Iterable, Iterator

from gz_course.grader.edits.edit import Edit, Text, Vocabulary
from gz_course.grader.edits.other import nearest, other_numbers

SENSOR_DATA = '__import__("rclpy.qos").qos.qos_profile_sensor_data'
TRANSIENT = (
    '__import__("rclpy.qos").qos.QoSProfile(depth=10, '
    'durability=__import__("rclpy.qos").qos.DurabilityPolicy.TRANSIENT_LOCAL)'
)
QOS_ARGUMENT = {"create_publisher": 2, "create_subscription": 3}
OTHER_FIELDS = {
    "x": ("y", "z"),
    "y": ("z", "x"),
    "z": ("x", "y"),
    "linear": ("angular",),
    "angular": ("linear",),
    "sec": ("nanosec",),
    "nanosec": ("sec",),
    "linear_acceleration": ("angular_velocity",),
    "angular_velocity": ("linear_acceleration",),
    "width": ("height",),
    "height": ("width",),
    "sin": ("cos",),
    "cos": ("sin",),
}
COMPARED: dict[type[ast.cmpop], tuple[str, ...]] = {
    ast.Lt: ("<=", ">", ">="),
    ast.LtE: ("<", ">", ">="),
    ast.Gt: (">=", "<", "<="),
    ast.GtE: (">", "<", "<="),
    ast.Eq: (">=", "<=", "!="),
    ast.NotEq: ("==", "<", ">"),
}
WALL_CLOCKS = {"time", "monotonic", "perf_counter"}
WRAPS = ("math.radians", "math.degrees", "abs", "float", "int", "round")
NO_VALUES = ("append", "publish", "spin", "__init__")  # functions that return nothing to go on with
NAMED = ("create_publisher", "create_subscription", "create_client", "create_service", "Subscriber", "ActionClient")


def other_values(text: Text, tree: ast.Module, vocabulary: Vocabulary) -> list[Edit]:
    """Return the edits of a file's expressions."""
    return _Values(text, vocabulary).of(tree)


class _Values(ast.NodeVisitor):
    def __init__(self, text: Text, vocabulary: Vocabulary) -> None:
        self._text = text
        self._vocabulary = vocabulary
        self._arguments: list[list[str]] = []  # of the functions around
        self._found: list[Edit] = []
        self._names: set[int] = set()  # id(node) of names of topics and services
        self._left: set[int] = set()  # id(node) of what other edits change better

    def of(self, tree: ast.Module) -> list[Edit]:
        self.visit(tree)
        return self._found

    def _source(self, node: ast.expr) -> str:
        begin, end = self._place(node)
        return self._text.content[begin:end].decode()

    def _place(self, node: ast.AST) -> tuple[int, int]:
        at: ast.expr = node  # type: ignore[assignment]
        assert at.end_lineno is not None and at.end_col_offset is not None
        return self._text.at(at.lineno, at.col_offset), self._text.at(at.end_lineno, at.end_col_offset)

    def _add(self, operator: str, node: ast.AST, others: str | Iterable[str]) -> None:
        begin, end = self._place(node)
        for now in [others] if isinstance(others, str) else others:
            self._found.append(self._text.edit(operator, node.lineno, begin, end, now))  # type: ignore[attr-defined]

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        self._arguments.append([each.arg for each in node.args.args])
        self.generic_visit(node)
        self._arguments.pop()

    def visit_ImportFrom(self, node: ast.ImportFrom) -> None:
        if not (node.module or "").endswith((".msg", ".srv")):
            return
        for alias in node.names:
            known = [each.replace("/", ".").rpartition(".") for each in self._vocabulary.types if "/msg/" in each]
            for module, _, name in known[:8]:
                if name != alias.name and module == f"{(node.module or '').partition('.')[0]}.msg":
                    now = f"{self._source(node)}; from {module} import {name} as {alias.asname or alias.name}"  # type: ignore[arg-type]
                    self._add("type", node, now)

    def visit_Constant(self, node: ast.Constant) -> None:
        value = node.value
        if id(node) in self._left:
            return
        if isinstance(value, bool):
            self._add("switch", node, repr(not value))
        elif isinstance(value, int | float):
            self._add("number", node, other_numbers(value, self._vocabulary))
        elif isinstance(value, str) and value and "\n" not in value:
            self._add("name" if id(node) in self._names else "text", node, self._other_texts(node, value))

    def _other_texts(self, node: ast.Constant, value: str) -> Iterator[str]:
        found: list[str] = []
        if value.startswith("/") or id(node) in self._names:
            found += nearest(value, self._vocabulary.topics)
            found.append(value[1:] if value.startswith("/") else f"/{value}")
        elif ("/" not in value and " " in value) or "_" in value or value.isalpha():
            found += nearest(value, self._vocabulary.texts)[:2]
        for mark in "@[]":
            if "@" in value and mark not in value[value.rfind("msg/") :]:
                begin, _, end = value.replace("[", "@").replace("]", "@").rpartition("@")
                found.append(f"{begin}{mark}{end}")
        yield from (repr(each) for each in found if each)

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        source = self._source(node)
        for other in nearest(source, (f"f{each!r}" for each in self._vocabulary.topics))[:1]:
            self._add("name", node, other)
        if "/" in source:
            self._add("name", node, source.replace('"/', '"', 1).replace("'/", "'", 1))

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        operand = node.operand
        if (
            isinstance(node.op, ast.USub)
            and isinstance(operand, ast.Constant)
            and isinstance(operand.value, int | float)
        ):
            self._add("number", node, other_numbers(-operand.value, self._vocabulary))
            return
        self.generic_visit(node)

    def visit_BinOp(self, node: ast.BinOp) -> None:
        left, right = self._source(node.left), self._source(node.right)
        operator = "sign" if isinstance(node.op, ast.Add | ast.Sub) else "arithmetic"
        self._add(operator, node, (f"({left})", f"({right})"))
        if isinstance(node.op, ast.Sub | ast.Div):
            self._add(operator, node, f"({right} {'-' if isinstance(node.op, ast.Sub) else '/'} {left})")
        self.generic_visit(node)

    def visit_Compare(self, node: ast.Compare) -> None:
        if len(node.ops) == 1:
            left, right = self._source(node.left), self._source(node.comparators[0])
            self._add("comparison", node, (f"{left} {op} {right}" for op in COMPARED.get(type(node.ops[0]), ())))
        self.generic_visit(node)

    def visit_If(self, node: ast.If) -> None:
        if not self._arguments:
            return  # whether the file is the program
        self._add("condition", node.test, f"not ({self._source(node.test)})")
        self.generic_visit(node)

    def visit_Attribute(self, node: ast.Attribute) -> None:
        if node.attr in OTHER_FIELDS:
            owner = self._source(node.value)
            self._add("field", node, (f"{owner}.{each}" for each in OTHER_FIELDS[node.attr]))
        self.generic_visit(node)

    def visit_Subscript(self, node: ast.Subscript) -> None:
        index = node.slice
        if isinstance(index, ast.Constant) and type(index.value) is int:
            others = dict.fromkeys((index.value + 1, index.value - 1, 0, -1))
            self._add("index", index, (repr(each) for each in others if each != index.value))
            self.visit(node.value)
        else:
            if isinstance(index, ast.Slice):
                self._add("index", node, self._source(node.value))
            self.generic_visit(node)

    def visit_Assign(self, node: ast.Assign) -> None:
        self._wrapped(node.value)
        self.generic_visit(node)

    def visit_Return(self, node: ast.Return) -> None:
        if node.value is not None:
            self._wrapped(node.value)
        self.generic_visit(node)

    def visit_Expr(self, node: ast.Expr) -> None:
        call = node.value
        if isinstance(call, ast.Constant):
            return  # a docstring
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id[:1].isupper():
            self._add("call", call, f'__import__("rclpy").spin({self._source(call)})')
        self.generic_visit(node)

    def _wrapped(self, value: ast.expr) -> None:
        """Try a value in other units, or as another type."""
        if isinstance(value, ast.Constant | ast.List | ast.Dict | ast.Tuple | ast.Lambda):
            return
        if isinstance(value, ast.Call) and (not value.args or _makes(value)):
            return
        source = self._source(value)
        self._add("conversion", value, f"-({source})")
        for each in WRAPS:
            function = each.replace("math.", '__import__("math").')
            self._add("conversion", value, f"{function}({source})")

    def visit_Call(self, node: ast.Call) -> None:
        function = node.func
        name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
        source = self._source(node)
        if name in ("__init__", "create_node", "Node"):
            self._left |= {id(each) for each in node.args[:1]}  # the name of a node is arbitrary
        if name in NAMED:
            self._names |= {id(each) for each in node.args if isinstance(each, ast.Constant)}
        if name in QOS_ARGUMENT and len(node.args) > QOS_ARGUMENT[name]:
            qos = node.args[QOS_ARGUMENT[name]]
            self._add("qos", qos, (SENSOR_DATA, "10", TRANSIENT))
            self._left.add(id(qos))
        positional = [each for each in node.args if not isinstance(each, ast.Starred)]
        if len(positional) == 1 == len(node.args) and not node.keywords and name not in NO_VALUES:
            self._add("conversion", node, f"({self._source(positional[0])})")
        for first, second in itertools.pairwise(positional if not _makes(node) else []):
            a, b = self._source(first), self._source(second)
            begin, end = self._place(first)[0], self._place(second)[1]
            between = self._text.content[self._place(first)[1] : self._place(second)[0]].decode()
            self._found.append(self._text.edit("arguments", first.lineno, begin, end, f"{b}{between}{a}"))
        for keyword in node.keywords:
            if keyword.arg in ("qos_profile", "qos"):
                self._add("qos", keyword.value, (SENSOR_DATA, "10", TRANSIENT))
            elif keyword.arg is not None:
                self._wrapped(keyword.value)
        if name == "range" and node.args:
            last = self._source(node.args[-1])
            self._add("index", node.args[-1], (f"({last}) + 1", f"({last}) - 1"))
        if name in WALL_CLOCKS and not node.args and "self" in self._arguments_here():
            self._add("clock", node, "(self.get_clock().now().nanoseconds * 1e-9)")
        if source.endswith("get_clock().now().to_msg()") and len(self._arguments_here()) > 1:
            self._add("clock", node, f"{self._arguments_here()[1]}.header.stamp")
        self.generic_visit(node)

    def _arguments_here(self) -> list[str]:
        return self._arguments[-1] if self._arguments else []

    def visit_List(self, node: ast.List) -> None:
        for element in node.elts:
            begin, end = self._place(element)
            after = self._text.content[end : end + 1] == b","
            self._found.append(self._text.edit("forgotten", element.lineno, begin, end + after, ""))
        self.generic_visit(node)

    def visit_comprehension(self, node: ast.comprehension) -> None:
        source = self._source(node.iter)
        if source.endswith(".ranges") and isinstance(node.target, ast.Name):
            message, value = source.removesuffix(".ranges"), node.target.id
            valid = f"{message}.range_min <= {value} <= {message}.range_max"
            for test in node.ifs:
                self._add("filter", test, valid)
            if not node.ifs:
                self._add("filter", node.iter, f"{source} if {valid}")
        self.generic_visit(node)


def _makes(call: ast.Call) -> bool:
    """Tell whether a call makes an object rather than a number."""
    function = call.func
    name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
    return name.startswith("create_") or name[:1].isupper()
