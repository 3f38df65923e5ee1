"""The names that platforms give: read from their beginning, by the form of the platform that made the whole export."""

import pytest

from gz_course.grader.submission.archive import Member
from gz_course.grader.whole_class.platforms import Export, is_late

STAMP = "2026-09-12-14-33-21"


def said(name, *others, folder=False):
    """Return student, id and file of a name beside others of the same export."""
    export = Export(dict.fromkeys((name, *others), folder))
    entry = export.entry(name, folder)
    return export.platform, entry.student, entry.id, entry.file


@pytest.mark.parametrize(
    ("name", "student", "id", "file"),
    [
        ("doejane_4711_99120_a.py", "doejane", "4711", "a.py"),
        ("doe_jane_LATE_4711_99120_a_1_22_b.py", "doe_jane", "4711", "a_1_22_b.py"),
        (
            "doejane_4711_99120_x_1001_assignsubmission_file_a.py",
            "doejane",
            "4711",
            "x_1001_assignsubmission_file_a.py",
        ),
        (f"doejane_4711_99120_L_x_attempt_{STAMP}_a.py", "doejane", "4711", f"L_x_attempt_{STAMP}_a.py"),
        ("doejane_4711_99120_12_13_LATE_14_15_a.py", "doejane", "4711", "12_13_LATE_14_15_a.py"),
        ("doejane_4711_text.html", "doejane", "4711", "doejane_4711_text.html"),
        ("LATE_anon_aB3xY_99120_a.py", "anon_aB3xY", "aB3xY", "a.py"),
        ("anon_12345_99120_a.py", "anon_12345", "12345", "a.py"),
    ],
)
def test_canvas(name, student, id, file):
    assert said(name, "roebob_4712_99121_b.py") == ("Canvas", student, id, file)


@pytest.mark.parametrize(
    ("name", "student", "id", "file"),
    [
        ("Jane Doe_17_assignsubmission_file_a.py", "Jane Doe", "17", "a.py"),
        ("Jane_Doe_17_assignsubmission_file_a.py", "Jane_Doe", "17", "a.py"),
        ("Jo_17_assignsubmission_file_x_1_assignsubmission_file_a.py", "Jo", "17", "x_1_assignsubmission_file_a.py"),
        ("Default group_assignsubmission_file_x_1_assignsubmission_file_a.py", "Default group", "",
         "x_1_assignsubmission_file_a.py"),
        ("Team 4_5_assignsubmission_onlinetext_onlinetext.html", "Team 4", "5", "onlinetext.html"),
        (f"Jane_17_assignsubmission_file_L_x_attempt_{STAMP}_a.py", "Jane", "17", f"L_x_attempt_{STAMP}_a.py"),
        ("Participant_123_124_assignsubmission_file_a.py", "Participant_123", "124", "a.py"),
    ],
)  # fmt: skip
def test_moodle(name, student, id, file):
    assert said(name, "Bob_18_assignsubmission_file_b.py") == ("Moodle", student, id, file)


@pytest.mark.parametrize("assignment", ["HW3", "Lab 3", "Lab_3", "HW_3_12"])
@pytest.mark.parametrize("login", ["jdoe", "j_doe", "1001"])
@pytest.mark.parametrize(
    "file", ["a.py", "roe_attempt_2099-01-01-00-00-00_a.py", "x_1_assignsubmission_file_a.py", "1_22_a.py"]
)
def test_blackboard(assignment, login, file):
    others = (f"{assignment}_roe_attempt_{STAMP}_a.py", f"{assignment}_roe_attempt_{STAMP}.txt")
    name = f"{assignment}_{login}_attempt_{STAMP}_{file}"
    assert said(name, *others, f"{assignment}_{login}_attempt_{STAMP}.txt") == ("Blackboard", login, login, file)


def test_a_few_names_in_the_form_of_a_platform_do_not_make_an_export():
    for name in ("x_1001_99120_a.py", "x_1001_assignsubmission_file_a.py", f"L_x_attempt_{STAMP}_a.py"):
        assert said(name, "bob.py") == ("", name.removesuffix(".py"), "", name)


def metadata(text):
    return Member(len(text), lambda most: text.encode()[:most])


ONE = "{}:\n  :submitters:\n  - :name: Eve\n    :sid: '1'\n"


def test_only_gradescope_numbers_its_folders_and_only_its_metadata_name_them():
    assert Export({"jane": True}, metadata(ONE.format("jane"))).platform == ""
    export = Export({"submission_1": True, "submission_2": True}, metadata(ONE.format("submission_1")))
    assert export.platform == "", "the other half would be named by nobody"
    export = Export({"submission_1": True}, metadata(ONE.format("submission_1")))
    entry = export.entry("submission_1", True)
    assert (export.platform, entry.student, entry.id) == ("Gradescope", "Eve", "1")


@pytest.mark.parametrize("name", ["[*a, *a]", "{x: *a}", "*b", "3.5", "null"])
def test_names_in_metadata_are_texts_and_nothing_that_grows(name):
    layers = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n"
    layers += "".join(f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]\n" for n in range(1, 12))
    text = layers + f"a: &a [*a11]\nb: &b {{c: *a}}\nsubmission_1:\n  :submitters:\n  - :name: {name}\n    :sid: *a\n"
    entry = Export({"submission_1": True}, metadata(text)).entry("submission_1", True)
    assert len(entry.student) < 100 and entry.id == ""


def test_late_is_said_by_the_beginning():
    assert is_late("Canvas", "doejane_LATE_4711_99120_a.py") and is_late("Canvas", "LATE_anon_abcde_99120_a.py")
    for platform, name in (("Canvas", "doejane_4711_99120_x_LATE_1_22_a.py"), ("", "doejane_LATE_4711_99120_a.py")):
        assert not is_late(platform, name)
