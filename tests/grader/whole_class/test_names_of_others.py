"""No name that a student can choose changes what others have handed in, on any platform."""

import stat
import zipfile
from contextlib import ExitStack

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from gz_course.grader.errors import RefusedError, UsageError
from gz_course.grader.learning_platforms.login_map import Person
from gz_course.grader.whole_class.found import find_submissions

FILE = "teleop_node.py"
STAMP = "2026-09-12-14-33-21"
OTHERS = {"jdoe": "1001", "roe": "1002", "a_b": "1003"}
# How a platform names the file of a student: the beginning is its own, `{file}` is the student's.
CANVAS = "{login}_{id}_9{id}_{file}"
MOODLE, MOODLE_FOLDERS = "{login}_{id}_assignsubmission_file_{file}", "{login}_{id}_assignsubmission_file/{file}"
BLACKBOARD = f"HW_3_{{login}}_attempt_{STAMP}_{{file}}"
BRIGHTSPACE_STAMP = "Sep 12, 2026 233 PM"
BRIGHTSPACE = f"{{id}}-77 - {{login}} - {BRIGHTSPACE_STAMP}/{{file}}"
BRIGHTSPACE_FILES = f"{{id}}-77 - {{login}} - {BRIGHTSPACE_STAMP} - {{file}}"
ANONYMOUS = "anon_x{id}_9{id}_{file}"
GRADESCOPE = "submission_{id}/{file}"
FORMS = {"Canvas": CANVAS, "Moodle": MOODLE, "Moodle folders": MOODLE_FOLDERS, "Blackboard": BLACKBOARD,
         "Brightspace": BRIGHTSPACE, "Brightspace files": BRIGHTSPACE_FILES, "Canvas anonymous": ANONYMOUS,
         "Gradescope": GRADESCOPE, "folders": "{login}/{file}"}  # fmt: skip

text = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0/\\"), min_size=1, max_size=12)
# What a name is made of if it is to be taken for that of another.
pieces = st.sampled_from(
    [*OTHERS, *OTHERS.values(), *(f"9{id}" for id in OTHERS.values()), "eve", "2000", "_", "_", "_", "LATE", "HW_3",
     "_assignsubmission_file_", "_assignsubmission_onlinetext_", f"_attempt_{STAMP}_", "_attempt_2099-01-01-00-00-00_",
     f"_attempt_{STAMP}.txt", "anon_", "anon_x1001_", " - ", f" - {BRIGHTSPACE_STAMP}", " - Sep 13, 2099 100 AM", "-77",
     ".PY", ".txt", "-2", "submission_1001", "submission_metadata.yml", FILE, "teleop_node", ".py", ".zip",
     ".tar.gz", "-1", ".", "..", " "]
)  # fmt: skip
imitations = st.builds(
    lambda form, login, id: form.format(login=login, id=id, file=FILE),
    st.sampled_from([CANVAS, MOODLE, BLACKBOARD, BRIGHTSPACE_FILES, ANONYMOUS]),
    st.sampled_from(sorted(OTHERS)),
    st.sampled_from(sorted(OTHERS.values())),
)
names = st.one_of(imitations, st.lists(st.one_of(pieces, text), min_size=1, max_size=8).map("".join))
names = names.filter(lambda name: name not in (".", "..") and len(name.encode()) < 200)


def metadata(students):
    return "".join(
        f"submission_{id}:\n  :submitters:\n  - :name: {login}\n    :sid: '{id}'\n" for login, id in students
    )


def read_all(path, exercise):
    """Return source -> (student, id, when, what it holds or why not), and what was left out."""
    with ExitStack() as stack:
        try:
            found, left_out = find_submissions(path, exercise, stack)
        except UsageError as error:
            return {}, [str(error)]
        told = {}
        for each in found:
            try:
                holds = each.read().files
            except UsageError as error:
                holds = str(error)
            assert each.source not in told
            told[each.source] = each.student, each.id, each.submitted, holds
        return told, left_out


def handed_in(path, form, files):
    """Write a zip in the form of a platform; `files` are (login, id, name, content)."""
    with zipfile.ZipFile(path, "w") as archive:
        for login, id, name, content in files:
            archive.writestr(form.format(login=login, id=id, file=name), content)
        if form == GRADESCOPE:
            archive.writestr("submission_metadata.yml", metadata(dict.fromkeys((f[0], f[1]) for f in files)))
    return path


@pytest.mark.parametrize("form", FORMS.values(), ids=FORMS)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(st.lists(names, min_size=1, max_size=2, unique=True))
@example([f"jdoe_attempt_2099-01-01-00-00-00_{FILE}"])
@example([f"jdoe_attempt_{STAMP}_{FILE}"])
@example([f"x_1001_assignsubmission_file_{FILE}", f"x_1002_assignsubmission_file_{FILE}"])
@example(["submission_metadata.yml"])
def test_others_have_what_they_have_without_him(exercise, tmp_path, form, chosen):
    others = [(login, id, FILE, f"x = {id}\n") for login, id in OTHERS.items()]
    eve = [("eve", "2000", name, "x = 0\n") for name in chosen]
    before, _ = read_all(handed_in(tmp_path / "before.zip", form, others), exercise)
    assert len(before) == len(OTHERS)
    after, _ = read_all(handed_in(tmp_path / "after.zip", form, eve + others), exercise)
    assert {source: after.get(source) for source in before} == before
    more = [told for source, told in after.items() if source not in before]
    assert all(told[1] not in OTHERS.values() for told in more)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(names, st.booleans())
@example("jdoe.zip", False)
@example("submission_metadata.yml", False)
@example("submission_1001", True)
def test_where_no_platform_names_anything_one_name_is_refused_to_both(exercise, tmp_path, chosen, folder):
    others = {f"{login}.py": f"x = {id}\n" for login, id in OTHERS.items()}
    name = f"{chosen}/{FILE}" if folder else chosen
    with zipfile.ZipFile(tmp_path / "class.zip", "w") as archive:
        for each, content in {name: "x = 0\n"}.items() | others.items():
            archive.writestr(each, content)
    told, _ = read_all(tmp_path / "class.zip", exercise)
    holds = {source: each[-1] for source, each in told.items()}
    for each, content in others.items():
        if each != name:
            both = [why for why in holds.values() if isinstance(why, str) and each in why]
            assert holds.get(each) == {each: content.encode()} or (both and chosen in both[0])


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None)
@given(st.lists(st.sampled_from(["eve", "x-jdoe", "jdoe-1", "x", "roe-jdoe"]), unique=True))
def test_no_login_takes_the_repository_of_another(exercise, tmp_path, logins):
    """The assignment before the login is the same for all, so that the end of a login decides nothing."""
    people = {name: Person(name, f"Student {name}", "") for name in [*OTHERS, *logins]}
    with zipfile.ZipFile(tmp_path / "class.zip", "w") as archive:
        for name in people:
            archive.writestr(f"03-teleop-{name}/{FILE}", name)
    with ExitStack() as stack:
        found, _ = find_submissions(tmp_path / "class.zip", exercise, stack, people)
        assert {each.student: each.read().files[FILE].decode() for each in found} == {
            f"Student {name}": name for name in people
        }


@pytest.fixture
def read(exercise, tmp_path):
    """Write a zip of (name, content) and return source -> what it holds or why not."""

    def look(*members):
        with zipfile.ZipFile(tmp_path / "class.zip", "w") as archive:
            for name, content in members:
                archive.writestr(name, content)
        return {source: told[-1] for source, told in read_all(tmp_path / "class.zip", exercise)[0].items()}

    return look


@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize(
    "members",
    [
        [("eve.py", "1"), ("eve.py", "2")],
        [(f"eve/{FILE}", "1"), (f"eve/{FILE}", "2")],
        [(f"eve/{FILE}", "1"), (f"./eve/./{FILE}", "2")],
        [(f"eve/{FILE}", "1"), ("eve", "2")],
        [("eve.py", "1"), ("eve.zip", "2")],
        [("eve.py", "1"), (f"eve/{FILE}", "2")],
        [("eve.tar.gz", "1"), ("eve.zip", "2")],
    ],
)
@pytest.mark.parametrize("inside", ["", "Lab 3/"])
def test_no_entry_replaces_another(read, members, inside):
    others = [(f"jane/{FILE}", "x"), (f"bob/{FILE}", "x")]
    told = read(*((inside + name, content) for name, content in [*others, *members]))
    assert told["jane"] == told["bob"] == {FILE: b"x"}
    (why,) = (each for source, each in told.items() if source not in ("jane", "bob"))
    assert "is graded" in why and "eve" in why
    if len({name.strip("./").partition("/")[0] for name, _ in members}) == 2:
        assert all(name.partition("/")[0] in why for name, _ in members)


def test_two_files_of_one_name_from_one_student_of_a_platform(read):
    told = read(
        (f"doejane_1_90_{FILE}", "1"), (f"doejane_1_91_{FILE}", "2"), (f"roe_2_92_{FILE}", "3"), ("roe_2_93_x.py", "4")
    )
    assert told[f"roe_2_92_{FILE}"] == {FILE: b"3", "x.py": b"4"}
    why = told[f"doejane_1_90_{FILE}"]
    assert f"doejane_1_90_{FILE} and doejane_1_91_{FILE} both hold '{FILE}', so neither is graded" in why


@pytest.mark.parametrize("inside", ["", "Lab 3/"])
def test_a_name_that_leads_out_of_a_folder_is_the_loss_of_its_student_only(read, inside):
    told = read(*((f"{inside}{name}/{FILE}", "x") for name in ("jane", "bob", "eve", "eve/../../jane")))
    assert told["jane"] == told["bob"] == {FILE: b"x"} and "leads out of it" in told["eve"]


def test_a_file_whose_name_has_empty_parts_is_not_the_loss_of_the_class(read):
    told = read((f"eve//{FILE}", "1"), (f"jane/{FILE}", "2"), ("bob//./x.py", "3"), (f"././al/{FILE}", "4"))
    assert told == {"eve": {FILE: b"1"}, "jane": {FILE: b"2"}, "bob": {"x.py": b"3"}, "al": {FILE: b"4"}}


@pytest.mark.parametrize("inside", ["", "Lab 3"])
def test_a_link_to_a_folder_at_the_top_is_named_and_not_followed(exercise, tmp_path, inside):
    place = tmp_path / "class" / inside
    for name in ("jane", "bob", "al"):
        (place / name).mkdir(parents=True)
        (place / name / FILE).write_text("x = 1\n")
    (place / "eve").symlink_to(tmp_path / "elsewhere")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / FILE).write_text("x = 2\n")
    told, left_out = read_all(tmp_path / "class", exercise)
    assert told["eve"][-1] == "eve is a link to a folder, which is not followed; put the folder there"
    assert left_out == [] and told["jane"][-1] == {FILE: b"x = 1\n"}


def test_the_only_folder_is_a_link(exercise, tmp_path):
    (tmp_path / "class").mkdir()
    (tmp_path / "class/eve").symlink_to("/")
    told, _ = read_all(tmp_path / "class", exercise)
    assert "is a link to a folder" in told["eve"][-1]


def test_a_link_in_a_zip_of_a_class_is_refused_to_its_student(exercise, tmp_path):
    with zipfile.ZipFile(tmp_path / "class.zip", "w") as archive:
        archive.writestr(f"jane/{FILE}", "x")
        link = zipfile.ZipInfo("eve.py")
        link.external_attr = (stat.S_IFLNK | 0o777) << 16
        archive.writestr(link, "/etc/passwd")
    with ExitStack() as stack:
        found = {each.student: each for each in find_submissions(tmp_path / "class.zip", exercise, stack)[0]}
        with pytest.raises(RefusedError, match="link"):
            found["eve"].read()
