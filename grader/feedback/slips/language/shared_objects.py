"""One object, list or attribute of a class that keeps what belongs to several: what one stores, the others get."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from gz_course.grader.feedback.facts.syntax import Place, assigned, calls, functions, nodes_of, unparse, walk
from gz_course.grader.feedback.slips import slip


@slip
def replaced_after_it_was_handed_over(tree: ast.AST) -> Iterator[Place]:
    """Find `self.planner = Planner(self.grid)` with another `self.grid = ...` later: the planner keeps the first."""
    keeps = {
        node.name
        for node in nodes_of(tree, ast.ClassDef)
        for method in node.body
        if isinstance(method, ast.FunctionDef) and method.name == "__init__"
        for target, value in assigned(method)
        if isinstance(target, ast.Attribute) and unparse(value) in {each.arg for each in method.args.args[1:]}
    }
    for owner in nodes_of(tree, ast.ClassDef):
        sets = [(target.lineno, unparse(target), value) for target, value in assigned(owner)]
        made = {name for _, name, value in sets if isinstance(value, ast.Call) and unparse(value.func)[:1].isupper()}
        for line, name, value in sets:
            given = [unparse(each) for each in value.args] if isinstance(value, ast.Call) else []
            if not isinstance(value, ast.Call) or unparse(value.func) not in keeps or not name.startswith("self."):
                continue
            twins = {unparse(of): other for _, other, of in sets if other.startswith("self.") and other != name}
            for one in (each for each in value.args if isinstance(each, ast.Call) and (each.args or each.keywords)):
                if unparse(one) in twins:
                    yield (
                        line,
                        f"{unparse(one)[:60]} is a second one here, beside {twins[unparse(one)]}, so {name} "
                        f"sees nothing of what comes into that: hand over {twins[unparse(one)]}",
                    )
                    return
            for each in made & set(given):
                later = [at for at, other, _ in sets if other == each and at > line]
                again = [at for at, other, _ in sets if other == name and at > line]
                if later and not again:
                    yield (
                        later[0],
                        f"{each} is made anew here, but {name} got the one before it (line {line}) and keeps that: "
                        f"what comes into the new one is never seen by {name}; make {each} once",
                    )
                    return


@slip
def one_object_for_two(tree: ast.AST) -> Iterator[Place]:
    """Find `self.front = self.own` where methods of both are the callbacks of two subscriptions."""
    listening = {
        unparse(each.value)
        for call, name in calls(tree)
        if name == "create_subscription"
        for each in (*call.args, *(word.value for word in call.keywords))
        if isinstance(each, ast.Attribute) and unparse(each.value).startswith("self.")
    }
    values: dict[str, list[tuple[int, str]]] = {}
    for target, value in assigned(tree):
        values.setdefault(unparse(target), []).append((target.lineno, unparse(value)))
    for name in sorted(listening & values.keys()):
        line, other = values[name][-1]
        if other in listening and other != name and len(values.get(other, ())) == 1:
            yield (
                line,
                f"{name} is {other} here, one object with two names, so both subscriptions store into it: make one "
                "for each",
            )
    for node in nodes_of(tree, ast.Assign):
        if len(node.targets) > 1 and isinstance(node.value, ast.Call):
            names = [unparse(each) for each in node.targets if unparse(each) in listening]
            if len(names) > 1 and all(len(values[each]) == 1 for each in names):
                yield (
                    node.lineno,
                    f"{' and '.join(names)} are one object with two names, so both subscriptions store into it: make "
                    "one for each",
                )


@slip
def kept_by_the_class(tree: ast.AST) -> Iterator[Place]:
    """Find `Robot.pose = ...` in a method of Robot that gets a message, where the file makes two objects of it."""
    made = [name for _, name in calls(tree)]
    for owner in nodes_of(tree, ast.ClassDef):
        if made.count(owner.name) < 2:
            continue
        for method in (node for node in owner.body if isinstance(node, ast.FunctionDef)):
            given = {each.arg for each in method.args.args[1:]}
            for target, value in assigned(method):
                whole = isinstance(target, ast.Attribute) and unparse(target.value)
                if whole != owner.name or not given & {unparse(each) for each in walk(value)}:
                    continue
                attribute = unparse(target).rpartition(".")[2]
                yield (
                    target.lineno,
                    f"{unparse(target)} belongs to the class, so all {made.count(owner.name)} objects of {owner.name} "
                    f"share it and the last message of any of them counts: self.{attribute} is one for each",
                )


@slip
def one_list_for_all(tree: ast.AST) -> Iterator[Place]:
    """Find `command = BASE` and `command += [...]` in a function that is called for each of several."""
    whole = tree.body if isinstance(tree, ast.Module) else []
    lists = {
        each.targets[0].id
        for each in whole
        if isinstance(each, ast.Assign) and isinstance(each.targets[0], ast.Name) and isinstance(each.value, ast.List)
    }
    for function in functions(tree) if lists else ():
        names = {
            target.id: (target.lineno, value.id)
            for target, value in assigned(function)
            if isinstance(target, ast.Name) and isinstance(value, ast.Name) and value.id in lists
        }
        for line, name in _grown(function):
            if name in names and _called_for_several(tree, function.name):
                set_in, base = names[name]
                yield (
                    line,
                    f"{name} is {base} itself (line {set_in}), not a copy, so this adds to {base}, and every call of "
                    f"{function.name}() finds what those before it have added: {name} = [*{base}] makes a new list",
                )
                break


def _grown(function: ast.FunctionDef) -> Iterator[tuple[int, str]]:
    """Yield the lists to which a function adds, each with its line."""
    for node in nodes_of(function, ast.AugAssign):
        if isinstance(node.op, ast.Add):
            yield node.lineno, unparse(node.target)
    for call, name in calls(function):
        if name in ("append", "extend", "insert") and isinstance(call.func, ast.Attribute):
            yield call.lineno, unparse(call.func.value)


def _called_for_several(tree: ast.AST, name: str) -> bool:
    """Return whether a function is called in several places, or in a loop."""
    loops = [node for node in walk(tree) if isinstance(node, ast.For | ast.While | ast.ListComp | ast.GeneratorExp)]
    return sum(each == name for _, each in calls(tree)) > 1 or any(
        each == name for loop in loops for _, each in calls(loop)
    )
