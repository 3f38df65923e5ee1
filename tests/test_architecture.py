"""The rooms of the house: which module may import which, how large a file may be, what is documented."""

import ast
import importlib
import json
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PACKAGES = {
    "gz": ROOT / "sim",
    "launch": ROOT / "sim",
    "launch_ros": ROOT / "sim",
    "ros_gz_bridge": ROOT / "sim",
    "ros_gz_image": ROOT / "sim",
    "ros_gz_sim": ROOT / "sim",
    "robot_state_publisher": ROOT / "sim",
    "grader": ROOT,
}
CODE_FOLDERS = ("sim", "grader", "exercises", "solutions", "chapters", "tests")
LONGEST_FILE = 400
VAGUE_NAMES = {"utils", "util", "helpers", "helper", "common", "misc"}
PRIVATE_FOLDERS = {"chapters", "exercises", "solutions"}
HEAVY = {"mujoco", "rclpy", "rerun"}


def modules():
    """Every module of ours: dotted name -> path."""
    found = {}
    for package, base in PACKAGES.items():
        for path in sorted((base / package).rglob("*.py")):
            parts = path.relative_to(base).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


MODULES = modules()
TREES = {name: ast.parse(path.read_text()) for name, path in MODULES.items()}


def is_type_checking(node):
    return isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)


def imports(name, *, only_types=True):
    """Dotted names of everything a module imports, wherever in it; also by `import_module("literal")`."""
    path, found = MODULES[name], set()
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]

    def walk(node):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                above = package.split(".")[: len(package.split(".")) - node.level + 1]
                base = ".".join([*above, *([base] if base else [])])
            found.add(base)
            found.update(f"{base}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[-1] in ("import_module", "__import__"):
            found.update(a.value for a in node.args[:1] if isinstance(a, ast.Constant))
        for child in ast.iter_child_nodes(node):
            if only_types or not is_type_checking(child):
                walk(child)

    walk(TREES[name])
    return found


def below(name, *tops):
    return any(name == top or name.startswith(f"{top}.") for top in tops)


def forbidden(name):
    """Which imports this module must not have, as a predicate on the imported name."""
    tops = set(PRIVATE_FOLDERS)
    messages = re.compile(r"\w+_(msgs|interfaces)(\.|$)")
    if below(name, "gz"):
        tops |= {
            "rclpy",
            "ros_gz_bridge",
            "ros_gz_sim",
            "launch",
            "launch_ros",
            "rosidl_runtime_py",
            "ament_index_python",
        }
        tops |= {"grader"}
    if below(name, "ros_gz_bridge"):
        tops |= {"mujoco", "gz.sim", "grader"}
    if below(name, "launch", "launch_ros"):
        tops |= {"rclpy", "mujoco", "gz", "ros_gz_bridge", "ros_gz_sim", "ros2", "grader"}
    if below(name, "launch"):
        tops |= {"launch_ros", "ament_index_python"}
    if below(name, "ros_gz_sim", "ros_gz_image", "robot_state_publisher"):
        tops |= {"grader", "mujoco", "gz.sim.world", "gz.sim.server"}
    if below(name, "gz.transport"):
        tops |= {"gz.sim", "mujoco"}
    if below(name, "gz.msgs"):
        tops |= {"gz.sim", "gz.transport", "gz.command"}
    if below(name, "grader.score", "grader.report"):
        tops |= {"rclpy", "mujoco", "grader.run", "gz", "ros_gz_bridge"}
    if below(name, "grader.run.agent"):
        tops |= {"mujoco", "rerun"}
        tops |= {
            n
            for n in MODULES
            if below(n, "grader") and not below("grader.run.agent", n) and not below(n, "grader.run.agent")
        }
    no_messages = below(name, "gz", "grader.score", "grader.report")
    return lambda imported: below(imported, *tops) or (no_messages and messages.match(imported) is not None)


def test_every_room_is_looked_at():
    assert {"gz", "ros_gz_bridge", "grader"} <= {name.split(".")[0] for name in MODULES}
    assert "grader.run.agent.course_agent.rclpy_7_1" in MODULES
    assert "grader.errors" in imports("grader.exercise")
    assert "rclpy.context" in imports("grader.run.agent.course_agent.rclpy_7_1"), "imports inside functions count too"


@pytest.mark.parametrize("name", sorted(MODULES))
def test_no_forbidden_arrow(name):
    is_forbidden = forbidden(name)
    assert [imported for imported in sorted(imports(name)) if is_forbidden(imported)] == []


def reachable(name):
    """Modules of ours that a module imports, directly or not, imports for types aside."""
    seen, todo = set(), [name]
    while todo:
        here = todo.pop()
        if here in seen or here not in MODULES:
            continue
        seen.add(here)
        todo += imports(here, only_types=False)
    return seen


@pytest.mark.parametrize("name", sorted(n for n in MODULES if below(n, "grader.score", "grader.report")))
def test_scoring_and_reports_reach_no_running_part_through_others(name):
    assert [other for other in sorted(reachable(name)) if below(other, "grader.run", "gz", "ros_gz_bridge")] == []


CODE = sorted(
    path
    for folder in CODE_FOLDERS
    for path in (ROOT / folder).rglob("*.py")
    if not {"__pycache__", ".ipynb_checkpoints"} & set(path.parts) and "cases" not in path.parts
)


def test_no_code_file_is_too_long():
    lengths = {str(path.relative_to(ROOT)): len(path.read_text().splitlines()) for path in CODE}
    assert {name: n for name, n in lengths.items() if n > LONGEST_FILE} == {}


def test_no_file_has_a_vague_name():
    assert [str(path) for path in CODE if path.stem in VAGUE_NAMES] == []
    assert [str(path.parent) for path in CODE if path.parent.name in VAGUE_NAMES] == []


@pytest.mark.parametrize("name", sorted(MODULES))
def test_everything_public_is_documented(name):
    tree, bare = TREES[name], []
    if MODULES[name].read_text().strip() and not ast.get_docstring(tree):
        bare.append("the module itself")
    todo = [(tree, "")]
    while todo:
        scope, prefix = todo.pop()
        for node in scope.body:
            if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
                continue
            overload = any("overload" in ast.unparse(d) or ".setter" in ast.unparse(d) for d in node.decorator_list)
            if node.name.startswith("_") or overload:
                continue
            if not ast.get_docstring(node):
                bare.append(f"{prefix}{node.name}")
            if isinstance(node, ast.ClassDef):
                todo.append((node, f"{node.name}."))
    assert bare == []


def exports(name):
    for node in TREES[name].body:
        if isinstance(node, ast.Assign) and any(ast.unparse(t) == "__all__" for t in node.targets):
            return ast.literal_eval(node.value)
    return None


@pytest.mark.parametrize("name", sorted(n for n in MODULES if exports(n) is not None))
def test_every_exported_name_resolves(name):
    module = importlib.import_module(name)
    assert [export for export in exports(name) if not hasattr(module, export)] == []
    assert len(set(exports(name))) == len(exports(name))


def loaded_by(code, *arguments):
    """Which top-level modules a fresh Python has loaded after some code."""
    program = f"""
import json, sys
sys.argv = ["course", *{list(arguments)!r}]
try:
    {code}
except SystemExit:
    pass
finally:
    print("\\n" + json.dumps(sorted({{name.split(".")[0] for name in sys.modules}})))
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=True, cwd=ROOT
    )
    return set(json.loads(done.stdout.splitlines()[-1]))


@pytest.mark.parametrize("package", ["gz.transport", "gz.msgs", "grader"])
def test_an_import_loads_nothing_heavy(package):
    assert loaded_by(f"import {package}") & HEAVY == set()


def test_scoring_loads_neither_ros_nor_the_simulator():
    loaded = loaded_by("import gz_course.grader.grade, grader.score.check as c; c.check_kinds()")
    assert loaded & {"mujoco", "rclpy", "gz", "ros_gz_bridge"} == set()


@pytest.mark.parametrize("arguments", [["--help"], ["grade", "--help"], ["list"]])
def test_help_and_lists_load_nothing_heavy(arguments):
    loaded = loaded_by("from gz_course.grader.course import main; main()", *arguments)
    assert "grader" in loaded
    assert loaded & (HEAVY | {"numpy", "pyarrow", "gz"}) == set()


def test_every_command_and_check_kind_has_a_file_of_its_own():
    import gz_course.grader.commands as grader_commands
    import gz_course.grader.score.checks as grader_score_checks
    from gz_course.grader.score.check import check_kinds

    assert set(check_kinds()) == {m.name for m in pkgutil.iter_modules(grader_score_checks.__path__)}
    for module in pkgutil.iter_modules(grader_commands.__path__):
        assert hasattr(importlib.import_module(f"gz_course.grader.commands.{module.name}"), "register")


def headings(path):
    """Anchors of a Markdown file, as GitHub makes them."""
    found = [line.lstrip("#").strip() for line in path.read_text().splitlines() if re.match(r"#+ ", line)]
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in found}


@pytest.mark.parametrize("document", ["README.md", "ARCHITECTURE.md"])
def test_links_of_the_documents_lead_somewhere(document):
    path = ROOT / document
    if not path.is_file() or not path.read_text().strip():
        pytest.skip(f"{document} is not written")
    dead = []
    for target in re.findall(r"\]\(([^)\s]+)(?:\s[^)]*)?\)", path.read_text()):
        if re.match(r"[a-z]+:", target):
            continue
        file, _, anchor = target.partition("#")
        there = ROOT / file if file else path
        if not there.exists() or (anchor and there.suffix == ".md" and anchor not in headings(there)):
            dead.append(target)
    assert dead == []
