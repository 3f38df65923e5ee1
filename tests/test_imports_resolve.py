"""Editors and type checkers find what our code imports: jedi, which reads the text alone, follows every import."""

import ast
import itertools
from pathlib import Path

import jedi
import pytest

ROOT = Path(__file__).parents[1]
TOPS = ("sim", "grader")
AT_RUN_TIME = "gz_course.sim.gz.msgs."  # `*_pb2` modules are made of the .proto texts when they are imported
SAMPLE = 40  # imports that `make test` tries
# `public` has the private namespace; from the others packages are run that know no other name of theirs than their own.
IMPORTED_FROM = ("public", "grader/run/agent", "grader/run/sandbox")


def own_imports():
    """Every import of ours, each module and name once: (file, line, column, what is imported)."""
    seen = {}
    for path in sorted(each for top in TOPS for each in (ROOT / top).rglob("*.py")):
        if "template" in path.parts or "share" in path.parts:
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            if not isinstance(node, ast.ImportFrom) or not (node.level or (node.module or "").startswith("gz_course")):
                continue
            if (node.module or "").startswith(AT_RUN_TIME) and (node.module or "").endswith("_pb2"):
                continue
            for name in node.names:
                key = (path.parent if node.level else None, node.level, node.module, name.name)
                seen.setdefault(key, (path, name.lineno, name.col_offset, f"{node.module}.{name.name}"))
    return list(seen.values())


def unresolved(imports):
    """Those of the imports that jedi does not follow to a file of this checkout."""
    project = jedi.Project(ROOT, added_sys_path=[str(ROOT / each) for each in IMPORTED_FROM], smart_sys_path=False)
    bad = []
    for path, in_file in itertools.groupby(imports, key=lambda each: each[0]):
        script = jedi.Script(path=path, project=project)  # one at a time: jedi's cache does not keep them all
        for _, line, column, name in in_file:
            found = script.goto(line, column, follow_imports=True)
            if not found or not all(each.module_path and each.module_path.is_relative_to(ROOT) for each in found):
                bad.append(f"{path.relative_to(ROOT)}:{line} imports {name}: jedi finds {found}")
    return bad


def test_a_sample_of_imports_resolves():
    imports = own_imports()
    assert len(imports) > 2000
    assert unresolved(imports[:: len(imports) // SAMPLE]) == []


@pytest.mark.proof
def test_every_import_resolves():
    assert unresolved(own_imports()) == []


def test_an_import_that_leads_nowhere_is_seen():
    path, line, _, name = own_imports()[0]
    assert unresolved([(path, line, 0, name)]) != []
