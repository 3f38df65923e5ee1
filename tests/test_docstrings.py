"""Docstrings say more than the name of what they document."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[1]
FILLERS = set(
    re.findall(r"\w+", "a an and as by for from in is it its of on one return self that the this to whether with")
)


def words(text):
    """The words of a name or a sentence, in lower case, without fillers and without a plural's s."""
    parts = re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", text)
    return {part.lower().removesuffix("s") for part in parts if part.lower() not in FILLERS}


def repeats(docstring, name, owner):
    """Whether every word of a docstring is in the name it documents, or in that of the class around it."""
    return words(docstring) <= words(name) | words(owner)


def documented(node, name, owner=""):
    """Yield name, owner and docstring of a module, class or function and of all definitions in it."""
    if docstring := ast.get_docstring(node):
        yield name, owner, docstring
    for child in node.body:
        if isinstance(child, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            yield from documented(child, child.name, name if isinstance(node, ast.ClassDef) else "")


def offenders(path):
    for name, owner, docstring in documented(ast.parse(path.read_text()), path.stem):
        if repeats(docstring, name, owner):
            yield f"{path.relative_to(ROOT)}: {name}: {docstring}"


def test_what_counts_as_a_repetition():
    assert repeats("Return the joint names.", "joint_names", "")
    assert repeats("Whether it is open.", "is_open", "")
    assert repeats("The pose of the link.", "pose", "Link")
    assert not repeats("Return the names in the order of the file.", "joint_names", "")
    assert not repeats("Return the period [s].", "period", "")


def test_no_docstring_merely_repeats_a_name():
    found = []
    for folder in ("sim", "grader"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            found += offenders(path)
    assert found == []
