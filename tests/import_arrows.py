"""How our modules import each other, read from their text."""

import ast
import functools
from pathlib import Path

ROOT = Path(__file__).parents[1]
NAMESPACE = "gz_course."  # an import name of ours is this and the path from the root
SIDES = ("gz", "bridge", "ros", "show")
PACKAGES_OF_PACKAGES = {"sim", *(f"sim/{side}" for side in SIDES)}


@functools.cache
def modules():
    """Every module of ours: its path from the root, without `.py` and `/__init__.py` -> file.

    Launch files, templates and the nodes of exercises are not modules: they are written like a student's, with public
    names.
    """
    found = {}
    files = [each for top in ("sim", "grader") for each in (ROOT / top).rglob("*.py")]
    files += [each for each in ROOT.glob("exercises/*/grading/*.py") if each.name != "given_node.py"]
    for path in sorted(files):
        parts = path.relative_to(ROOT).with_suffix("").parts
        if "template" in parts or parts[:4] == ("sim", "ros", "prefix", "share"):
            continue
        found["/".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def tree(name):
    return ast.parse(modules()[name].read_text())


def place(dotted):
    """Return where an imported name lies: `sim/gz/sim` for `gz_course.sim.gz.sim`, else `rclpy/node`."""
    return dotted.removeprefix(NAMESPACE).replace(".", "/")


def last_name(node):
    """Return `c` of `c` and of `a.b.c`, and nothing of another expression."""
    return getattr(node, "attr", getattr(node, "id", ""))


def is_type_checking(node):
    return isinstance(node, ast.If) and last_name(node.test) == "TYPE_CHECKING"


@functools.cache
def imports(name, *, with_types=True, doors=True):
    """Return the places of everything a module imports, wherever in it; also by `import_module("literal")`.

    Without `doors`, `from package import module` asks for the module only, not for `package/__init__.py`.
    """
    found = set()
    package = name if modules()[name].name == "__init__.py" else name.rpartition("/")[0]
    text = modules()[name].read_text()
    by_call = "import_module" in text or "__import__" in text  # else no expression imports anything

    def walk(node):
        if isinstance(node, ast.Import):
            found.update(place(alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = place(node.module or "")
            if node.level:
                above = package.split("/")[: len(package.split("/")) - node.level + 1]
                base = "/".join([*above, *(node.module or "").split(".")]).rstrip("/")
            names = {f"{base}/{alias.name}" for alias in node.names}
            if doors or not names <= modules().keys():
                found.update({base} - PACKAGES_OF_PACKAGES)  # what is meant is in the names
            found.update(names)
        elif isinstance(node, ast.Call) and last_name(node.func) in ("import_module", "__import__"):
            found.update(place(a.value) for a in node.args[:1] if isinstance(a, ast.Constant))
        for child in ast.iter_child_nodes(node):
            if (by_call or not isinstance(child, ast.expr)) and (with_types or not is_type_checking(child)):
                walk(child)

    walk(tree(name))
    return found


def below(name, *tops):
    return f"{name}/".startswith(tuple(f"{top}/" for top in tops))


def reachable(name):
    """Return the modules of ours that a module imports, directly or not, imports for types aside."""
    seen, todo = set(), [name]
    while todo:
        here = todo.pop()
        if here in seen or here not in modules():
            continue
        seen.add(here)
        todo += imports(here, with_types=False)
    return seen


def cycles(arrows):
    """Return the groups of modules that reach each other, each sorted; `arrows` is module -> what it imports.

    Source: R. Tarjan, Depth-first search and linear graph algorithms, 1972 (strongly connected components)
    """
    order, lowest, path, found = {}, {}, [], []

    def visit(name):
        order[name] = lowest[name] = len(order)
        path.append(name)
        for other in sorted(arrows.get(name, ())):
            if other not in order:
                visit(other)
            if other in path:
                lowest[name] = min(lowest[name], lowest[other])
        if lowest[name] == order[name]:
            start = path.index(name)
            found.append(sorted(path[start:]))
            del path[start:]

    for name in arrows:
        if name not in order:
            visit(name)
    return [group for group in found if len(group) > 1]
