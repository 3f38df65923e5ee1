"""Typing mistakes in a manifest are named without a run, by `course list` and before `course verify` grades."""

import re
import shutil
import tomllib

import pytest

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import CheckSpec, exercise_names, find_exercise
from gz_course.grader.score.check import check_kinds, perform
from gz_course.grader.verify.manifest_faults import NothingHappened, manifest_faults

NAME = "00_first_run"
ALTERNATIVES = {"per_scan": ("signal",), "text": ("log",), "within": ("start",)}  # that manuals name, too
EXAMPLE = re.compile(r'^ *kind = "(?P<kind>\w+)"\n(?:(?! *"""| *\n).+\n)*', re.MULTILINE)


@pytest.fixture
def spoilt(tmp_path, root):
    """`spoilt(old, new)`: a course with one exercise whose manifest was changed; `spoilt.path` is its folder."""
    for half in ("exercises", "solutions"):
        shutil.copytree(root / half / NAME, tmp_path / half / NAME)
    manifest = tmp_path / "exercises" / NAME / "grading/exercise.toml"

    def change(old, new):
        text = manifest.read_text()
        assert old in text
        manifest.write_text(text.replace(old, new, 1))
        return manifest_faults(find_exercise(NAME, tmp_path))

    change.path = tmp_path
    return change


def test_the_manifests_of_the_course_have_none(root):
    assert [fault for name in exercise_names(root) for fault in manifest_faults(find_exercise(name, root))] == []


def test_a_leaderboard_names_a_check_that_measures(spoilt):
    table = '[[leaderboard]]\nname = "Seconds"\ncheck = "arrives"\nbest = "lowest"\n\n[[check]]'
    (said,) = spoilt("[[check]]", table)
    assert "leaderboard 'Seconds': a check of kind 'messages' measures no number; these do: change" in said
    with pytest.raises(ManifestError, match="leaderboard 'Seconds' names no check: 'arrivse'; did you mean 'arrives'"):
        spoilt('check = "arrives"', 'check = "arrivse"')


CHECK = '[[check]]\nid = "more"\ntitle = "More"\npoints = 5\nhint = "Think."\n'


@pytest.mark.parametrize(
    ("check", "words"),
    [
        ('kind = "txet"\n', ["'more'", "'txet'", "did you mean 'text'?"]),
        ('kind = "change"\nsignal = "truth/robot/x"\nband = [0, 1]\nunti = "m"\n', ["'more'", "'unti'", "'unit'"]),
        ('kind = "change"\nsignal = 3\nband = [0, 1]\n', ["'more'", "signal", "a text"]),
        (
            'kind = "change"\nsignal = "truth/robot/x"\nband = [0, 1]\ngate = { check = "mor", otherwise = "no" }\n',
            ["'more'", "'mor'", "did you mean 'more'?"],
        ),
        (
            'kind = "change"\nsignal = "truth/robot/x"\nband = [0, 1]\ngate = { check = "more", otherwise = "no" }\n',
            ["wait for each other"],
        ),
        (
            'kind = "change"\nsignal = "truth/robot/x"\nband = [0, 1]\ngate = { signal = "x", reach = 1 }\n',
            ["reaches"],
        ),
        ('kind = "python"\nfunction = "chekcs.py:f"\n', ["'more'", "chekcs.py, which does not exist"]),
    ],
)
def test_a_check_with_a_typing_mistake(spoilt, check, words):
    faults = spoilt("[[check]]", f"{CHECK}{check}\n[[check]]")
    assert len(faults) == 1, faults
    assert [word for word in [*words, "exercise.toml"] if word not in faults[0]] == [], faults


def test_a_message_type_with_a_typing_mistake(spoilt):
    (fault,) = spoilt("std_msgs/msg/String", "std_msgs/msg/Strign")
    assert "/hello" in fault and "did you mean 'std_msgs/msg/String'?" in fault


def test_every_mistake_is_named_at_once_by_both_commands(spoilt, course):
    spoilt("std_msgs/msg/String", "std_msgs/msg/Strign")
    spoilt("[[check]]", f'{CHECK}kind = "txet"\n\n[[check]]')
    for command in ("list", "verify"):
        outcome = course(command, COURSE_ROOT=str(spoilt.path))
        assert outcome.code == 3, outcome.output
        assert outcome.words.count("WRONG") == 2 and "'txet'" in outcome.words and "Strign" in outcome.words
        assert "solution" not in outcome.stdout, "nothing was graded"


def test_a_students_copy_is_not_asked(spoilt, course):
    spoilt("std_msgs/msg/String", "std_msgs/msg/Strign")
    shutil.rmtree(spoilt.path / "solutions")
    assert course("list", COURSE_ROOT=str(spoilt.path)).code == 0


def examples(root):
    """Yield the example in the manual of each kind of check."""
    for name in check_kinds():
        text = (root / "grader/score/checks" / f"{name}.py").read_text().partition('"""\n\nfrom')[0]
        for found in EXAMPLE.finditer(text):
            yield name, found.group()


def test_every_kind_reads_its_parameters_though_nothing_happened(root):
    """Else a right manifest is refused: the examples of the manuals are right ones."""
    exercise = find_exercise(NAME, root)
    told = []
    for name, example in examples(root):
        if name == "python":
            continue
        parameters = tomllib.loads(example)
        parameters.pop("kind")
        for key in ("id", "title", "points", "hint", *ALTERNATIVES.get(name, ())):
            parameters.pop(key, None)
        spec = CheckSpec("it", "It", 1, name, ("Think.",), parameters)
        perform(spec, NothingHappened(exercise), exercise.grading, lambda _: None)
        told.append(name)
    assert set(told) == set(check_kinds()) - {"python"}


@pytest.mark.parametrize(
    ("type", "request_", "words"),
    [
        ("std_srvs/srv/SetBoll", "data = true", ["'std_srvs/srv/SetBoll'", "did you mean 'std_srvs/srv/SetBool'?"]),
        ("std_srvs/srv/SetBool", "dta = true", ["'dta'", "did you mean 'data'?"]),
    ],
)
def test_a_call_with_a_typing_mistake(spoilt, type, request_, words):
    script = f'[[script]]\nat = 1.0\nservice = "/reset"\ntype = "{type}"\nrequest = {{ {request_} }}\n'
    (fault,) = spoilt("[[script]]", f"{script}\n[[script]]")
    assert [word for word in words if word not in fault] == [], fault


def test_a_trial_that_changes_a_check_wrongly(spoilt):
    trial = '[[trial]]\nname = "long"\n\n[trial.check.arrives]\nwindwo = [0, 3]\n'
    (fault,) = (
        spoilt("[[trial]]", f"{trial}\n[[trial]]")
        if has_trials(spoilt)
        else spoilt("[[script]]", f"{trial}\n[[script]]")
    )
    assert "in the trial 'long'" in fault and "'windwo'" in fault


def has_trials(spoilt):
    return "\n[[trial]]" in (spoilt.path / "exercises" / NAME / "grading/exercise.toml").read_text()
