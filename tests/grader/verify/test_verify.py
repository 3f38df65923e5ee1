"""What a private half declares, and `course verify`, which finds out halves that do not fit: a copy, spoilt once."""

import re
import shutil

import pytest

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.verify import variants

NAME = "03_teleop"


@pytest.fixture
def copy(tmp_path, root):
    """A course with one exercise, both halves; `copy.solutions / ...` may be spoilt."""
    for half in ("exercises", "solutions"):
        shutil.copytree(root / half / NAME, tmp_path / half / NAME)

    class Copy:
        folder = tmp_path
        public = tmp_path / "exercises" / NAME
        private = tmp_path / "solutions" / NAME
        expect = private / "expect.toml"

        def declared(self):
            return variants(find_exercise(NAME, tmp_path))

    return Copy()


def edit(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_all_variants_of_both_halves_are_declared(copy):
    names = [variant.name for variant in copy.declared()]
    assert names[:2] == ["starter", "solution"]
    assert {"accepted/two_timers", "rejected/never_stops", "rejected/wrong_topic"} <= set(names)
    starter, solution = copy.declared()[:2]
    assert len(starter.fails) == 6 and solution.fails == frozenset()
    never = next(v for v in copy.declared() if v.name == "rejected/never_stops")
    assert never.fails == {"five_seconds", "stops"} and never.words


def wrong(copy, *words):
    with pytest.raises(ManifestError) as caught:
        copy.declared()
    assert [word for word in words if word not in str(caught.value)] == [], str(caught.value)


def test_a_declared_variant_without_a_folder(copy):
    (copy.private / "rejected/never_stops").rename(copy.private / "rejected/never_stop")
    wrong(copy, "expect.toml", "rejected/never_stops", "did you mean 'never_stop'?")


def test_a_folder_nobody_declared(copy):
    (copy.private / "rejected/extra").mkdir()
    wrong(copy, "rejected/extra", "not declared in expect.toml")


def test_an_accepted_folder_without_the_file(copy):
    (copy.private / "accepted/two_timers/teleop_node.py").rename(copy.private / "accepted/two_timers/teleop.py")
    wrong(copy, "accepted/two_timers", "teleop_node.py", "teleop.py")


def test_a_solution_without_the_file(copy):
    (copy.private / "teleop_node.py").unlink()
    wrong(copy, f"solutions/{NAME}", "teleop_node.py")


def test_an_unknown_check(copy):
    edit(
        copy.expect,
        '[rejected.never_stops]\nfails = ["five_seconds", "stops"]',
        '[rejected.never_stops]\nfails = ["stopps"]',
    )
    wrong(copy, "expect.toml", "rejected.never_stops", "stopps", "did you mean 'stops'?")


def test_no_expectations_at_all(copy):
    copy.expect.unlink()
    wrong(copy, f"solutions/{NAME}", "expect.toml")


def test_no_private_half(copy):
    shutil.rmtree(copy.private)
    wrong(copy, f"solutions/{NAME}", "expect.toml")


@pytest.mark.parametrize("text", ["[rejected", "rejected = 3", b"# \xff"])
def test_expectations_that_cannot_be_read(copy, text):
    copy.expect.write_bytes(text if isinstance(text, bytes) else text.encode())
    wrong(copy, "expect.toml")


@pytest.mark.parametrize("key", ["fails", "words"])
def test_a_rejected_variant_that_lacks_a_key(copy, key):
    entry, rest = re.split(r"\n(?=\n\[rejected.turns_right\])", copy.expect.read_text(), maxsplit=1)
    copy.expect.write_text(re.sub(rf"\n{key} = .*", "", entry) + rest)
    wrong(copy, "expect.toml", "never_stops", key)


@pytest.mark.parametrize(
    ("old", "key"), [('fails = ["five_seconds", "stops"]', "fails"), ('words = ["left"]', "words")]
)
def test_a_rejected_variant_that_asks_for_nothing(copy, old, key):
    edit(copy.expect, old, f"{key} = []")
    wrong(copy, "expect.toml", key)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("equivalent = []", ("equivalent", "list of texts")),
        ('equivalents = ["1: a -> b"]', ("equivalent",)),
        ("equivalent = 3", ("equivalent",)),
    ],
)
def test_mutants_that_are_declared_badly(copy, text, words):
    copy.expect.write_text(f"{copy.expect.read_text()}\n[mutants]\n{text}\n")
    wrong(copy, "expect.toml", *words)


def test_a_hidden_trial_that_nobody_has(copy):
    edit(copy.expect, 'words = ["left"]', 'words = ["left"]\ntrial = "norht"')
    trials = copy.private / "trials.toml"
    trials.write_text(trials.read_text() + '\n[[trial]]\nname = "north"\nseed = 3\n')
    wrong(copy, "rejected.turns_right", "trial is 'norht'", "did you mean 'north'?")
    edit(copy.expect, 'trial = "norht"', 'trial = "north"')
    assert {v.name: v.trial for v in copy.declared()}["rejected/turns_right"] == "north"


def test_an_unknown_table_in_the_expectations(copy):
    copy.expect.write_text(copy.expect.read_text() + '\n[rejcted.more]\nfails = ["stops"]\nwords = ["x"]\n')
    wrong(copy, "expect.toml", "rejcted")


def run(copy, course, *arguments):
    return course("verify", "--no-mutants", *arguments, COURSE_ROOT=str(copy.folder), timeout=600)


def test_a_private_half_without_its_public_one_is_found(copy, course):
    shutil.copytree(copy.private, copy.folder / "solutions" / "99_orphan")
    shutil.rmtree(copy.public)
    outcome = run(copy, course)
    assert outcome.code != 0
    assert "99_orphan" in outcome.words and NAME in outcome.words


def test_a_public_half_without_its_private_one_is_found(copy, course):
    shutil.rmtree(copy.private)
    outcome = run(copy, course)
    assert outcome.code == 3
    assert NAME in outcome.words and "expect.toml" in outcome.words


KEPT = {"rejected/never_stops", "rejected/turns_right", "accepted/two_timers"}


def quicker(copy):
    """Keep few variants, so that all of it is graded in seconds."""
    for folder in (*copy.private.glob("accepted/*"), *copy.private.glob("rejected/*")):
        if f"{folder.parent.name}/{folder.name}" not in KEPT:
            shutil.rmtree(folder)
    entries = re.split(r"\n(?=\[)", copy.expect.read_text())
    kept = [entry for entry in entries if entry.startswith(("[rejected.never_stops]", "[rejected.turns_right]"))]
    copy.expect.write_text("\n".join(kept))


@pytest.mark.proof
def test_wrong_expectations_are_found_out(copy, course, clean):
    """One grading of all variants shows every kind of fault at once."""
    quicker(copy)
    # Says it loses less than it does; asks for a word that is nowhere; earns full marks though rejected.
    edit(copy.expect, '["five_seconds", "stops"]', '["five_seconds", "turns_left"]')
    edit(copy.expect, 'words = ["left"]', 'words = ["leftovers"]')
    shutil.copy(copy.private / "teleop_node.py", copy.private / "rejected/turns_right")
    # An accepted variant that is wrong, and a starter that is right.
    shutil.copy(copy.private / "rejected/never_stops/teleop_node.py", copy.private / "accepted/two_timers")
    shutil.copy(copy.private / "teleop_node.py", copy.public)
    outcome = run(copy, course)
    clean(outcome)
    assert outcome.code == 1, outcome.output
    told = outcome.words
    for sentence in (
        "rejected/never_stops: fails stops, which it must pass",
        "rejected/never_stops: passes turns_left, which it must fail",
        "rejected/turns_right: passes commands_left, which it must fail",
        "'leftovers' (nowhere does it stand)",
        "accepted/two_timers: fails stops, which it must pass",
        "starter: passes drives_forward, which it must fail",
        "no rejected variant fails the check stops",
        "no rejected variant fails the check drives_forward",
        "1 accepted variants, at least 2 are needed",
        "2 rejected variants, at least 6 are needed",
    ):
        assert sentence in told, f"{sentence}\n\n{outcome.output}"
    assert "WRONG 03_teleop starter" in told and "ok 03_teleop solution" in told


def test_an_unknown_exercise_is_a_usage_error(course):
    outcome = course("verify", "03_telepo")
    assert outcome.code == 2
    assert "03_teleop" in outcome.words


def test_a_students_copy_has_nothing_to_prove(copy, course):
    shutil.rmtree(copy.folder / "solutions")
    outcome = run(copy, course)
    assert outcome.code == 2
    assert "a student's copy has no solutions to prove" in outcome.words
