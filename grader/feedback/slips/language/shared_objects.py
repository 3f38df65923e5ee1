"""One object, list, array or variable for several: what one stores, the others get.

Source: https://docs.python.org/3/faq/programming.html, "Why do lambdas defined in a loop with different values all
return the same result?"
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from gz_course.grader.feedback.facts.syntax import (
    Place,
    Words,
    assigned,
    calls,
    children,
    functions,
    last_name,
    nodes_of,
    unparse,
    walk,
)
from gz_course.grader.feedback.slips import slip, slip_of

Function = ast.Lambda | ast.FunctionDef
# What keeps a function that it is given, and calls it later. `sorted` and `map` call it at once.
LATER = frozenset({
    "OpaqueFunction", "OnProcessStart", "OnProcessExit", "OnProcessIO", "OnShutdown", "OnExecutionComplete",
    "create_subscription", "create_timer", "create_service", "add_done_callback", "add_on_set_parameters_callback",
    "registerCallback",
})  # fmt: skip
Comprehension = ast.ListComp | ast.GeneratorExp | ast.SetComp | ast.DictComp
MAKES = frozenset({"zeros", "ones", "full", "empty", "array", "zeros_like", "list", "dict", "set"})
CHANGES = frozenset({"append", "extend", "add", "update", "fill", "insert"})


@slip
def late_bound(tree: ast.AST) -> Iterator[Place]:
    """Find a function that reads the variable of a loop when the loop has given it its last value."""
    for loop in walk(tree):
        parts: Sequence[ast.AST]
        if isinstance(loop, ast.For):
            parts, bound = loop.body, _stored(loop.target)
            bound |= {name for part in parts for name in _stored(part)}
        elif isinstance(loop, Comprehension):
            parts = [loop.key, loop.value] if isinstance(loop, ast.DictComp) else [loop.elt]
            bound = {name for each in loop.generators for name in _stored(each.target)}
        else:
            continue
        if not any(isinstance(each, ast.Return | ast.Break) for part in parts for each in _own(part)):
            yield from _in_loop(parts, bound)


def _in_loop(parts: Sequence[ast.AST], bound: set[str]) -> Iterator[Place]:
    nodes = [each for part in parts for each in _own(part)]
    named = {each.name: each for each in nodes if isinstance(each, ast.FunctionDef)}
    for call in (each for each in nodes if isinstance(each, ast.Call)):
        if unparse(call.func).rpartition(".")[2] not in LATER:
            continue
        for given in [*call.args, *(each.value for each in call.keywords)]:
            function = named.get(given.id) if isinstance(given, ast.Name) else given
            if not isinstance(function, Function):
                continue
            free = sorted(_read(function) & bound - _own_names(function))
            if free:
                name, what = free[0], "lambda" if isinstance(function, ast.Lambda) else f"function {function.name}"
                written = [each.arg for each in function.args.args]
                head = ", ".join([*written, f"{name}={name}"])
                right = f"lambda {head}:" if isinstance(function, ast.Lambda) else f"def {function.name}({head})"
                yield (
                    function.lineno,
                    f"this {what} reads {name} when it is called, and the loop is over then: every one of them gets "
                    f"the last value of {name}. A default keeps the value of this iteration, {right}",
                )


def _own(part: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a part of a loop, without those inside of a function that is made there."""
    yield part
    if isinstance(part, ast.Lambda | ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return
    for child in children(part):
        yield from _own(child)


def _stored(part: ast.AST) -> set[str]:
    return {each.id for each in _own(part) if isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store)}


def _read(function: Function) -> set[str]:
    body = function.body if isinstance(function.body, list) else [function.body]
    names = (each for part in body for each in nodes_of(part, ast.Name))
    return {each.id for each in names if isinstance(each.ctx, ast.Load)}


def _own_names(function: Function) -> set[str]:
    """Return the names that a function binds itself: its parameters, and what it assigns."""
    bound = {each.arg for each in nodes_of(function, ast.arg)}
    return bound | {each.id for each in nodes_of(function, ast.Name) if isinstance(each.ctx, ast.Store)}


@slip
def one_array(tree: ast.AST) -> Iterator[Place]:
    """Find `self.hits = self.passes = np.zeros(...)`, and `self.passes = self.hits`, where both are changed."""
    changed = _changed(tree)
    made: set[str] = set()
    for function in (each for each in functions(tree) if each.name == "__init__"):
        for node in nodes_of(function, ast.Assign):
            names = [unparse(target) for target in node.targets]
            if _makes(node.value):
                made |= set(names)
            elif unparse(node.value) in made:
                names.append(unparse(node.value))
            both = [name for name in names if name in changed]
            if len(both) > 1 and (_makes(node.value) or unparse(node.value) in made):
                yield (
                    node.lineno,
                    f"{unparse(node)[:70]} gives one array two names, so what is added to {both[0]} is in "
                    f"{both[1]}, too: make each of its own",
                )


@slip_of(ast.FunctionDef)
def one_local(function: ast.FunctionDef) -> Words:
    """Find `misses = hits = set()` in a function that adds to both by different calls."""
    for node in (each for each in nodes_of(function, ast.Assign) if len(each.targets) > 1):
        names = [each.id for each in node.targets if isinstance(each, ast.Name)]
        new = {unparse(one) for one, _ in assigned(function) if one not in node.targets}
        added = [
            name
            for name in names
            if any(each in CHANGES and unparse(call.func).startswith(f"{name}.") for call, each in calls(function))
        ]
        if _makes(node.value) and len(added) > 1 and not new & set(names):
            yield (
                node,
                f"{unparse(node)[:70]} gives one collection two names, so what is added to {added[0]} is in "
                f"{added[1]}, too: make each of its own",
            )


def _makes(value: ast.expr) -> bool:
    if isinstance(value, ast.BinOp) and isinstance(value.op, ast.Mult):
        return isinstance(value.left, ast.List)
    return isinstance(value, ast.List | ast.Dict) or (isinstance(value, ast.Call) and last_name(value.func) in MAKES)


def _changed(tree: ast.AST) -> set[str]:
    """Return the attributes whose parts are changed in place, in a function of the file that gets them, too."""
    changing = {each.name: _parts_set(each) for each in functions(tree)}
    found = set().union(*changing.values()) if changing else set()
    for call, name in calls(tree):
        if isinstance(call.func, ast.Attribute) and name in CHANGES:
            found.add(unparse(call.func.value))
        if unparse(call.func).endswith("add.at") and call.args:
            found.add(unparse(call.args[0]))
        own = next((each for each in functions(tree) if each.name == name), None)
        if own is not None:
            names = [each.arg for each in own.args.args if each.arg != "self"]
            for parameter, given in zip(names, call.args, strict=False):
                if parameter in changing[own.name]:
                    found.add(unparse(given))
    return {each for each in found if each.startswith("self.")}


def _parts_set(function: ast.FunctionDef) -> set[str]:
    """Return the names of which parts are assigned."""
    found = set()
    for node in nodes_of(function, ast.Subscript):
        whole: ast.expr = node
        while isinstance(whole, ast.Subscript):
            whole = whole.value
        if isinstance(node.ctx, ast.Store):
            found.add(unparse(whole))
    return found


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
