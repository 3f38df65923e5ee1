"""Programs that mean the same: with other names, or with each function's body in a block of its own."""

import ast
import itertools

KEPT = frozenset({"self", "cls", "main", "args", "Node", "data", "generate_launch_description"})


def _on_self(node: ast.AST) -> bool:
    return isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self"


def own_names(tree: ast.AST) -> list[str]:
    """Return the names that a program gives: all of which nothing outside of it may know."""
    nodes = list(ast.walk(tree))
    given = [node.id for node in nodes if isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load)]
    given += [node.arg for node in nodes if isinstance(node, ast.arg)]
    given += [node.name for node in nodes if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef)]
    given += [node.attr for node in nodes if _on_self(node) and not isinstance(node.ctx, ast.Load)]
    outside = {node.attr for node in nodes if isinstance(node, ast.Attribute) and not _on_self(node)}
    outside |= {word.arg for node in nodes if isinstance(node, ast.Call) for word in node.keywords}
    imports = [node for node in nodes if isinstance(node, ast.Import | ast.ImportFrom)]
    outside |= {(name.asname or name.name).partition(".")[0] for node in imports for name in node.names}
    for node in nodes:
        if isinstance(node, ast.ClassDef):  # what a base of another library may call, and fields of data classes
            outside |= {
                each.name for each in node.body if isinstance(each, ast.FunctionDef) and each.name.startswith("on_")
            }
            outside |= {
                each.target.id
                for each in node.body
                if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name)
            }
        elif isinstance(node, ast.Global | ast.Nonlocal):
            outside |= set(node.names)
        elif isinstance(node, ast.ExceptHandler | ast.MatchAs | ast.MatchStar) and node.name:
            outside.add(node.name)
    return [name for name in dict.fromkeys(given) if name not in outside | KEPT and not name.startswith("__")]


def renamed(source: str, word: str) -> str:
    """Return a program whose own names are `word` with a number."""
    tree = ast.parse(source)
    numbers = itertools.count(1)
    names = {name: f"{word}{next(numbers)}" for name in own_names(tree)}
    for node in ast.walk(tree):
        match node:
            case ast.Name():
                node.id = names.get(node.id, node.id)
            case ast.arg():
                node.arg = names.get(node.arg, node.arg)
            case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
                node.name = names.get(node.name, node.name)
            case ast.Attribute() if _on_self(node):
                node.attr = names.get(node.attr, node.attr)
    return ast.unparse(tree)


def wrapped(source: str) -> str:
    """Return a program in which each function does its work in a context that changes nothing."""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef) and node.name != "__init__":
            begin = 1 if ast.get_docstring(node) is not None else 0
            if node.body[begin:]:
                node.body[begin:] = [
                    ast.With([ast.withitem(ast.Call(ast.Name("nullcontext"), [], []))], node.body[begin:])
                ]
    return ast.unparse(ast.fix_missing_locations(tree))
