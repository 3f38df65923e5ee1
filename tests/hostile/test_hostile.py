"""Submissions that mean harm: each folder in `cases/` attacks before it drives as it should, or instead.

`attack.py` is imported by an otherwise honest submission. It prints a line with ESCAPED for whatever it should not
have been able to do, and one beginning with `held` for what it has tried in vain. `expected.toml` has the `outcomes`
that are right, `points`, `words` of the diagnosis, and `tried`: how many `held` there must be at least, so that an
attack that never took place is no success. Afterwards the same worker must give full marks to an honest submission.

With `exercise`, the attack stands at the beginning of a copy of that exercise's `submission` (a folder of its
solution); in `10_actions` its function `attacked` takes the place of the server's `on_goal`. With `uses = ["rtps"]`,
the functions of `cases/rtps.py` come before the attack, and so with other files there. `most_points` takes the place of
`points` where an attack spoils its own run.

`held` means nothing for an attack that cannot succeed: `test_witnesses.py` runs what `uses` `attempts` without a wall.

A table `[C]` or `[D]` in `expected.toml` replaces those keys at that level. `documented` in it quotes the row of the
table in `docs/instructors.md` that says what the level does not hold, and `escapes` has words of the lines with ESCAPED
that this excuses. At D, which stops no hostile code, neither is needed.
"""

import os
import tomllib

import pytest

from gz_course.grader.run.sandbox.probe import try_level

from .conftest import ORDINARY, ROOT, WorkerGoneError

CASES = ROOT / "tests/hostile/cases"
NAMES = sorted(path.parent.name for path in CASES.glob("*/expected.toml"))
QUICK = {"reads_what_is_not_for_it"}  # the others belong to `make verify`
ROOT_ONLY = pytest.mark.skipif(os.getuid() != 0, reason="only root can become an ordinary user")
KINDS = [
    pytest.param(("A", None), id="A"),
    pytest.param(("A", ORDINARY), id="A-ordinary-user", marks=[ROOT_ONLY, pytest.mark.proof]),
    pytest.param(("B", None), id="B", marks=[pytest.mark.proof]),
    pytest.param(("B", ORDINARY + 1), id="B-ordinary-user", marks=[ROOT_ONLY, pytest.mark.proof]),
    pytest.param(("C", None), id="C", marks=[ROOT_ONLY, pytest.mark.proof]),
    pytest.param(("C", ORDINARY + 3), id="C-ordinary-user", marks=[ROOT_ONLY, pytest.mark.proof]),
    pytest.param(("D", None), id="D", marks=[ROOT_ONLY, pytest.mark.proof]),
    pytest.param(("D", ORDINARY + 4), id="D-ordinary-user", marks=[ROOT_ONLY, pytest.mark.proof]),
]


@pytest.fixture(params=KINDS)
def worker(request, workers):
    level, user = request.param
    if user is None and level != "D" and (lack := try_level(level)):
        pytest.skip(f"no level {level} here: {lack}")
    return workers(level, user)


@pytest.fixture
def tell(request):
    """Tell the table of attacks what a test has found."""
    return lambda **found: request.node.user_properties.extend(found.items())


@pytest.mark.parametrize("case", [pytest.param(n, marks=() if n in QUICK else pytest.mark.proof) for n in NAMES])
def test_an_attack_comes_to_nothing(case, worker, solution, tell, request):
    want = tomllib.loads((CASES / case / "expected.toml").read_text())
    want |= want.get(worker.level, {})
    attack = text_of(case, want)
    files = {"teleop_node.py": f"import attack\n{solution}", "attack.py": attack}
    if "exercise" in want:
        files = attacking(attack, ROOT / "solutions" / want["exercise"], want["submission"])
    if worker.level == "D":  # no other attack is to meet what this one does to its grader
        request.addfinalizer(worker.close)
    try:
        told = worker.grade(files, want.get("exercise", "03_teleop"))
        faults = list(faults_of(told, want, worker.level))
    except WorkerGoneError:
        if worker.level != "D":
            raise
        tell(verdict="documented")
        return
    excused = [each for each in faults if worker.level == "D" or any(word in each for word in want.get("escapes", ()))]
    assert faults == excused, "\n".join(faults)
    tell(verdict="documented" if faults else "contained", left=worker.counted())
    if worker.level == "D":  # what was held all the same is no promise
        return

    honest = worker.grade({"teleop_node.py": solution})
    assert (honest["report"]["score"], honest["report"]["pace"]) == (100, "lockstep"), honest["report"]["diagnosis"]
    assert honest["children"] == [] and worker.left() == []
    # Nothing grows from one grading to the next.
    assert honest["descriptors"] <= told["descriptors"]
    assert (honest["network"], honest["mounts"]) == (told["network"], told["mounts"])


def text_of(case, want):
    """The text of an attack, with what it uses before it."""
    files = [*(f"{name}.py" for name in want.get("uses", ())), f"{case}/attack.py"]
    return "\n".join((CASES / name).read_text() for name in files)


def attacking(attack, solved, variant):
    """The files of a variant of a solved exercise, whose program begins with an attack."""
    files = {
        str(p.relative_to(solved)): p.read_text() for p in (solved / "patrol_interfaces").rglob("*") if p.is_file()
    }
    (program,) = (solved / variant).glob("*.py")
    text, start = program.read_text(), 'if __name__ == "__main__":'
    assert start in text
    if "def attacked(" in attack:
        text = text.replace(start, f"PatrolServer.on_goal = attacked(PatrolServer.on_goal)\n\n{start}")
    return files | {program.name: f"{attack}\n{text}"}


def faults_of(told, want, level):
    """Sentences on what an attack has achieved. Raises AssertionError if it did not take place."""
    report, log = told["report"], told["log"]
    escaped = [line for line in log if "ESCAPED" in line]
    held = sum(line.startswith("held") for line in log)
    ended = report["outcome"] not in want["outcomes"]
    assert held + len(escaped) >= want.get("tried", 0) or (level == "D" and ended), f"it did not take place: {log}"
    yield from escaped
    score, most = report["score"], want.get("most_points")
    if ended or (score != want["points"] if most is None else score > most):
        yield f"{report['outcome']}, {report['score']} points: {report['diagnosis']} {log[-20:]}"
    yield from (
        f"no {word!r} in: {report['diagnosis']}" for word in want.get("words", []) if word not in report["diagnosis"]
    )
    if report["sandbox"] != level:
        yield f"graded at level {report['sandbox']}"
    if told["children"]:
        yield f"processes are left: {told['children']}"
