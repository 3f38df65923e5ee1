"""Edits of a Python file, each a typical mistake: a sign, a number, a name, QoS, a condition, a forgotten line.

Only the edited place of the text changes; the file is not regenerated from its syntax tree, so the line numbers stay.
"""

from __future__ import annotations

import ast

from gz_course.grader.edits.edit import Edit, Text, Vocabulary
from gz_course.grader.edits.python_statements import moved
from gz_course.grader.edits.python_values import QOS_ARGUMENT, SENSOR_DATA, TRANSIENT, other_values
from gz_course.grader.feedback.facts.syntax import parsed

COMPARED: dict[type[ast.cmpop], str] = {
    ast.Lt: ">",
    ast.LtE: ">",
    ast.Gt: "<",
    ast.GtE: "<",
    ast.Eq: "!=",
    ast.NotEq: "==",
    ast.Is: "is not",
    ast.IsNot: "is",
    ast.In: "not in",
    ast.NotIn: "in",
}
CALLED = {"min": "max", "max": "min", "floor": "ceil", "ceil": "floor", "sin": "cos", "cos": "sin", "any": "all"}
CALLED |= {"all": "any"}
FIELDS = {"x": "y", "y": "x", "linear": "angular", "angular": "linear", "range_min": "range_max"}
FIELDS |= {"range_max": "range_min", "angle_min": "angle_max", "angle_max": "angle_min"}
# function -> index of the argument that is a name
NAMED = {"create_publisher": 1, "create_subscription": 1, "create_client": 1, "create_service": 1}
QOS = {"create_publisher": SENSOR_DATA, "create_subscription": TRANSIENT}
FORGOTTEN = ("publish", "cancel", "send_request", "call_async")  # calls that may be left out
# Arguments that do not change what a node does.
UNTOUCHED = ("num_threads", "timeout_sec", "depth")


def breaking(text: Text) -> list[Edit]:
    """Return the edits that break a right program."""
    finder = _Finder(text)
    finder.visit(parsed(text.content))
    return finder.found


def mending(text: Text, vocabulary: Vocabulary) -> list[Edit]:
    """Return further edits, which could mend a wrong program."""
    tree = parsed(text.content)
    return [*other_values(text, tree, vocabulary), *moved(text, tree)]


class _Finder(ast.NodeVisitor):
    def __init__(self, text: Text) -> None:
        self._text = text
        self._untouched: set[int] = set()  # id(node) of numbers and texts that stay
        self.found: list[Edit] = []

    def _add(self, operator: str, node: ast.expr | ast.stmt, now: str) -> None:
        assert node.end_lineno is not None and node.end_col_offset is not None
        begin, end = self._text.at(node.lineno, node.col_offset), self._text.at(node.end_lineno, node.end_col_offset)
        self.found.append(self._text.edit(operator, node.lineno, begin, end, now))

    def _leave(self, *nodes: ast.AST) -> None:
        self._untouched |= {id(node) for each in nodes for node in ast.walk(each)}

    def visit_If(self, node: ast.If) -> None:
        if (
            isinstance(node.test, ast.Compare)
            and isinstance(node.test.left, ast.Name)
            and node.test.left.id == "__name__"
        ):
            return
        self._conditions(node.test)
        self.generic_visit(node)

    def visit_IfExp(self, node: ast.IfExp) -> None:
        self._conditions(node.test)
        self.generic_visit(node)

    def visit_comprehension(self, node: ast.comprehension) -> None:
        for test in node.ifs:
            self._add("condition", test, "True")
        self.generic_visit(node)

    def _conditions(self, test: ast.expr) -> None:
        for value in ("True", "False"):
            self._add("condition", test, value)

    def visit_Compare(self, node: ast.Compare) -> None:
        if len(node.ops) == 1 and id(node) not in self._untouched:
            left, right = (ast.unparse(each) for each in (node.left, node.comparators[0]))
            self._add("comparison", node, f"{left} {COMPARED[type(node.ops[0])]} {right}")
        elif len(node.ops) == 2:
            for op, first, second in zip(node.ops, [node.left, *node.comparators], node.comparators, strict=False):
                # Forget one of the two bounds.
                self._add("comparison", node, f"{ast.unparse(first)} {_symbol(op)} {ast.unparse(second)}")
        self.generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        other = " or " if isinstance(node.op, ast.And) else " and "
        self._add("logic", node, f"({other.join(f'({ast.unparse(value)})' for value in node.values)})")
        self.generic_visit(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        if isinstance(node.op, ast.Not):
            self._add("logic", node, f"({ast.unparse(node.operand)})")
        elif isinstance(node.op, ast.USub):
            self._add("sign", node, f"({ast.unparse(node.operand)})")
            self._leave(node.operand)
        self.generic_visit(node)

    def visit_BinOp(self, node: ast.BinOp) -> None:
        swapped = {ast.Add: "-", ast.Sub: "+", ast.Mult: "/", ast.Div: "*"}.get(type(node.op))
        if swapped and not any(_is_text(side) for side in (node.left, node.right)):
            operator = "sign" if swapped in "+-" else "arithmetic"
            self._add(operator, node, f"({ast.unparse(node.left)} {swapped} {ast.unparse(node.right)})")
        self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> None:
        value = node.value
        if id(node) in self._untouched:
            return
        if isinstance(value, int | float) and not isinstance(value, bool):
            if value:
                self._add("sign", node, f"(-{value!r})")
            self._add("number", node, repr(2 * value if value else value + 1))
        elif isinstance(value, str) and len(value) > 1:
            self._add("text", node, repr(value[:-1]))

    def visit_Subscript(self, node: ast.Subscript) -> None:
        self._leave(node.slice)
        self.generic_visit(node)

    def visit_Attribute(self, node: ast.Attribute) -> None:
        if node.attr in FIELDS:
            self._add("field", node, f"{ast.unparse(node.value)}.{FIELDS[node.attr]}")
        self.generic_visit(node)

    def visit_Assign(self, node: ast.Assign) -> None:
        if isinstance(node.targets[0], ast.Attribute) and isinstance(node.targets[0].value, ast.Attribute):
            self._add("forgotten", node, "pass")
        self.generic_visit(node)

    def visit_Expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Constant):  # a docstring
            return
        call = node.value
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute) and call.func.attr in FORGOTTEN:
            self._add("forgotten", node, "pass")
        self.generic_visit(node)

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        for part in node.values:
            if isinstance(part, ast.FormattedValue):
                self.visit(part.value)  # only the formatted value; its format and the text around it stay

    def visit_Call(self, node: ast.Call) -> None:
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        if name in CALLED:
            begin = ast.unparse(node.func).removesuffix(name)
            self._add("call", node.func, begin + CALLED[name])
        if name in NAMED and len(node.args) > NAMED[name]:
            topic = node.args[NAMED[name]]
            if isinstance(topic, ast.Constant) and isinstance(topic.value, str):
                self._add("name", topic, repr(topic.value[:-1]))
            self._leave(topic)
        if name in QOS and len(node.args) > QOS_ARGUMENT[name]:
            qos = node.args[QOS_ARGUMENT[name]]
            self._add("qos", qos, QOS[name])
            self._leave(qos)
        if name in ("__init__", "create_node", "Node"):
            self._leave(*node.args[:1])  # the name of a node is arbitrary
        self._leave(*(keyword.value for keyword in node.keywords if keyword.arg in UNTOUCHED))
        self.generic_visit(node)


def _symbol(op: ast.cmpop) -> str:
    return ast.unparse(ast.Compare(ast.Constant(0), [op], [ast.Constant(0)])).strip("0 ")


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))
