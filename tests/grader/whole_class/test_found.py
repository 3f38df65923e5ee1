"""Whose submission is what: folders, files and archives as learning platforms name them, and hostile names."""

import io
import os
import stat
import zipfile
from contextlib import ExitStack

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.grader.errors import RefusedError, UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.learning_platforms.login_map import Person
from gz_course.grader.whole_class.found import find_submissions

NODE = b"x = 1\n"
FILE = "teleop_node.py"


@pytest.fixture
def find(exercise):
    with ExitStack() as stack:
        yield lambda path: find_submissions(path, exercise, stack)


@pytest.fixture
def found(find):
    """Student -> what was found of them; nothing but a page of the platform's may be left out."""

    def look(path):
        submissions, left_out = find(path)
        assert left_out in ([], ["index.html"])
        return {each.student: each for each in submissions}

    return look


def zipped(folder, path):
    with zipfile.ZipFile(path, "w") as archive:
        for each in sorted(folder.rglob("*")):
            archive.write(each, each.relative_to(folder))
    return path


def packed(**files):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, data in files.items():
            archive.writestr(name.replace("__", "."), data)
    return stream.getvalue()


LONG = "Maria-José Núñez de la Fuente y Fernández-Montesinos, von und zu Hohenlohe-Waldenburg-Schillingsfürst"
CLASSES = {
    "a folder each": ({"alice/teleop_node.py": b"a", "bob/teleop_node.py": b"b"}, {"alice": b"a", "bob": b"b"}),
    "a file each, of any suffix": ({"alice.PY": b"a", "bob.py.txt": b"b"}, {"alice": b"a", "bob": b"b"}),
    "a file each": ({"alice.py": b"a", "bob smith.py": b"b"}, {"alice": b"a", "bob smith": b"b"}),
    "an archive each": ({"alice.zip": packed(teleop_node__py=b"a"), "bob.py": b"b"}, {"alice": b"a", "bob": b"b"}),
    "Moodle": (
        {
            "Jane Doe_123_assignsubmission_file_/teleop_node.py": b"a",
            "Jane Doe_123_assignsubmission_onlinetext_/onlinetext.html": b"<p>",
            "Jürgen_45_assignsubmission_file/teleop.zip": packed(teleop_node__py=b"b"),
        },
        {"Jane Doe": b"a", "Jürgen": b"b"},
    ),
    "Moodle without folders": (
        {"Jane Doe_123_assignsubmission_file_teleop_node.py": b"a", "Al_9_assignsubmission_file_teleop_node.py": b"b"},
        {"Jane Doe": b"a", "Al": b"b"},
    ),
    "Canvas": (
        {
            "doejane_4711_99120_teleop_node-2.py": b"a",
            "doejane_4711_99121_speeds.py": b"s",
            "roebob_LATE_4712_99122_teleop_node.py": b"b",
        },
        {"doejane": b"a", "roebob": b"b"},
    ),
    "Blackboard": (
        {
            "Lab 3_jdoe_attempt_2026-09-12-14-33-21_teleop_node.py": b"old",
            "Lab 3_jdoe_attempt_2026-09-13-08-00-00_teleop_node.py": b"a",
            "Lab 3_jdoe_attempt_2026-09-13-08-00-00.txt": b"Name: Jane Doe",
        },
        {"jdoe": b"a"},
    ),
    "Canvas, anonymous": (
        {
            "anon_aB3_99120_teleop_node-1.py": b"a",
            "anon_aB3_99121_speeds-1.py": b"s",
            "LATE_anon_x9Yz7Q_99122_teleop_node.PY": b"b",
        },
        {"anon_aB3": b"a", "anon_x9Yz7Q": b"b"},
    ),
    "Moodle with long names and groups": (
        {
            f"{LONG}_123_assignsubmission_file_/teleop_node.py": b"a",
            f"{LONG}_124_assignsubmission_file_/week 3/teleop_node.py.txt": b"b",
            "Group 4_77_assignsubmission_file_/teleop_node.py": b"c",
            "Default group_assignsubmission_file_/mine.py": b"d",
        },
        {f"{LONG} (123)": b"a", f"{LONG} (124)": b"b", "Group 4": b"c", "Default group": b"d"},
    ),
    "Brightspace": (
        {
            "index.html": b"<p>",
            "1001-77 - Jane Doe - Sep 12, 2026 1133 PM/teleop_node.py": b"old",
            "1001-77 - Jane Doe - Sep 13, 2026 108 AM/teleop_node.py": b"a",
            "1002-77 - Jane Doe - Sep 12, 2026 1200 PM/teleop_node.py": b"b",
            "1003-77 - Team 2 - Al - 12 September 2026 912 AM/teleop_node.py": b"c",
        },
        {"Jane Doe (1001)": b"a", "Jane Doe (1002)": b"b", "Team 2 - Al": b"c"},
    ),
    "Brightspace without folders": (
        {
            "1001-77 - Jane Doe - Sep 12, 2026 1133 PM - teleop_node.py": b"a",
            "1002-77 - Al - Sep 12, 2026 1134 PM - my - Sep 13, 2026 1134 PM - node.py": b"b",
        },
        {"Jane Doe": b"a", "Al": b"b"},
    ),
    "Gradescope": (
        {
            "submission_metadata.yml": b"submission_1:\n  :submitters:\n  - :name: Jane Doe\n    :sid: '77'\n"
            b"submission_2:\n  :submitters:\n  - :name: Al\n    :sid: 1\n  - :name: Bo\n    :sid: 2\n",
            "submission_1/teleop_node.py": b"a",
            "submission_2/teleop_node.py": b"b",
        },
        {"Jane Doe": b"a", "Al & Bo": b"b"},
    ),
    "copies of the course": (
        {
            "lab-alice/exercises/03_teleop/teleop_node.py": b"a",
            "lab-alice/exercises/04_lidar_listener/lidar_subscriber.py": b"",
            "lab-bob/exercises/03_teleop/teleop_node.py": b"b",
        },
        {"lab-alice": b"a", "lab-bob": b"b"},
    ),
}


@pytest.mark.parametrize("name", CLASSES)
@pytest.mark.parametrize("form", ["folder", "zip", "zip of a folder"])
def test_a_class_as_a_platform_hands_it_out(found, hand_in, tmp_path, name, form):
    files, wanted = CLASSES[name]
    path = hand_in(files, "top/Lab 3") if form == "zip of a folder" else hand_in(files)
    if form != "folder":
        path = zipped(path.parent if form == "zip of a folder" else path, tmp_path / "class.zip")
    read = {student: each.read() for student, each in found(path).items()}
    if form == "zip of a folder" and len(wanted) == 1:
        return  # one folder with one student's work in it is that student's folder
    assert {student: chosen.files[chosen.main] for student, chosen in read.items()} == wanted


def test_ids_of_a_platform_are_kept(found, hand_in):
    students = found(hand_in(CLASSES["Moodle"][0]))
    assert (students["Jane Doe"].id, students["Jürgen"].id) == ("123", "45")
    assert students["Jane Doe"].source == "Jane Doe_123_assignsubmission_file_"


def test_files_of_one_canvas_student_belong_together(found, hand_in):
    chosen = found(hand_in(CLASSES["Canvas"][0]))["doejane"].read()
    assert chosen.files == {FILE: b"a", "speeds.py": b"s"}


def test_a_resubmission_numbers_every_file_of_an_exercise(root, hand_in):
    files = {"convoy.launch.py": b"l", "follower_node.py": b"f"}
    names = {f"doejane_4711_9912{n}_{name[:-3]}-1.py": data for n, (name, data) in enumerate(files.items())}
    with ExitStack() as stack:
        ((each,), _) = find_submissions(hand_in(names), find_exercise("11_many_robots", root), stack)
        chosen = each.read()
    assert chosen.files == files and len(chosen.notes) == 2


def test_a_lone_file_of_a_platform_gets_a_note_and_a_students_own_name_none(found, hand_in):
    (of_canvas,) = found(hand_in({"doejane_4711_99120_robot.py": NODE})).values()
    assert "There is no teleop_node.py; robot.py" in of_canvas.read().notes[0]
    (plain,) = found(hand_in({"jane.py": NODE}, "other")).values()
    assert plain.read().notes == ()


def test_attempts_at_one_minute_are_not_guessed_between(found, hand_in):
    stamp = "Sep 12, 2026 1133 PM"
    names = [
        f"1001-77 - Jane Doe - {stamp} - {FILE}",
        f"1001-77 - Jane Doe - {stamp}/{FILE}",
        f"2-77 - B - {stamp}/{FILE}",
    ]
    with pytest.raises(RefusedError, match=f"both hold '{FILE}', so neither is graded"):
        found(hand_in(dict.fromkeys(names, NODE)))["Jane Doe"].read()


def test_repositories_of_github_classroom_and_a_map(exercise, hand_in):
    names = ("jdoe", "x-jdoe", "Roe", "nobody")
    path = hand_in({f"03-teleop-{name}/exercises/03_teleop/{FILE}": name for name in names}, "class/03-submissions")
    people = {name: Person(name, f"{name} Smith", f"k{n}") for n, name in enumerate(("jdoe", "x-jdoe", "roe"))}
    with ExitStack() as stack:
        submissions, _ = find_submissions(path.parent, exercise, stack, people)
        told = {each.student: (each.id, each.platform, each.read().files[FILE].decode()) for each in submissions}
        assert told == {
            "jdoe Smith": ("k0", "GitHub Classroom", "jdoe"),
            "x-jdoe Smith": ("k1", "GitHub Classroom", "x-jdoe"),
            "roe Smith": ("k2", "GitHub Classroom", "Roe"),
            "03-teleop-nobody": ("", "", "nobody"),
        }
        with pytest.raises(UsageError, match=r"no folder in .* ends in a login of the map, as in 03-teleop-ada"):
            find_submissions(path, exercise, stack, {"ada": Person("ada", "Ada", "")})


def test_students_of_one_name_are_kept_apart(found, hand_in):
    names = [f"Jane Doe_{number}_assignsubmission_file_/{FILE}" for number in (1, 2)]
    students = found(hand_in({name: NODE for name in names} | {f"jane doe/{FILE}": NODE}))
    assert sorted(students) == ["Jane Doe (1)", "Jane Doe (2)", "jane doe"]


def test_names_that_differ_only_in_bytes_nobody_can_print(found, hand_in, tmp_path):
    hand_in({"a.py": NODE})
    for raw in (b"te\xff.py", b"te\xfe.py"):
        (tmp_path / "class" / os.fsdecode(raw)).write_bytes(NODE)
    students = found(tmp_path / "class")
    assert len(students) == 3 and len({each.casefold() for each in students}) == 3
    assert all(student.isprintable() and student.encode() for student in students)


@pytest.mark.parametrize("name", ["=1+1", "@SUM(A1)", "a\nb", "\x1b[2J", "x" * 200, " ", "'; DROP TABLE", "<b>", "..."])
def test_hostile_names_are_printable_and_not_endless(found, hand_in, name):
    (student,) = found(hand_in({f"{name}/{FILE}": NODE}))
    assert student.isprintable() and 0 < len(student) <= 130


def test_what_is_no_submission_is_named(find, hand_in):
    files = {"notes.txt": "", "grades.csv": "", f"alice/{FILE}": NODE, ".DS_Store": "", "__MACOSX/x": "", ".x/a": ""}
    submissions, left_out = find(hand_in(files))
    assert ([each.student for each in submissions], left_out) == (["alice"], [".x", "grades.csv", "notes.txt"])


def test_nothing_at_all(find, hand_in, tmp_path):
    for path in (hand_in({"notes.txt": ""}), tmp_path / "empty.zip"):
        if path.suffix == ".zip":
            zipfile.ZipFile(path, "w").close()
        with pytest.raises(UsageError, match="no submissions"):
            find(path)


def test_a_class_that_is_no_zip(find, tmp_path):
    (tmp_path / "class.zip").write_bytes(b"nothing")
    with pytest.raises(UsageError, match="cannot be read as an archive"):
        find(tmp_path / "class.zip")


@pytest.mark.parametrize(
    ("files", "words"),
    [
        ({"eve/other.py": NODE, "eve/more.py": NODE}, ["eve", FILE, "asks for"]),
        ({"eve/x.bin": NODE}, ["eve", FILE]),
        ({"eve.zip": b"junk"}, ["eve.zip", "cannot be read"]),
        ({"eve.rar": b"Rar!"}, ["eve.rar", ".zip"]),
    ],
)
def test_a_submission_without_the_file_is_one_students_own_fault(found, hand_in, files, words):
    students = found(hand_in(files | {f"bob/{FILE}": NODE}))
    assert students["bob"].read().files == {FILE: NODE}
    with pytest.raises(UsageError) as caught:
        students["eve"].read()
    assert [word for word in words if word not in str(caught.value)] == []
    assert "/" not in str(caught.value), "no path of this machine"


def test_an_empty_folder_is_somebodys(found, hand_in):
    path = hand_in({f"bob/{FILE}": NODE})
    (path / "eve").mkdir()
    with pytest.raises(UsageError, match=f"eve holds no {FILE}"):
        found(path)["eve"].read()


def test_links_lead_nowhere(found, hand_in):
    path = hand_in({f"bob/{FILE}": NODE, "eve/readme": b""})
    (path / "eve" / FILE).symlink_to(path / "bob" / FILE)
    (path / "mallory.py").symlink_to(path / "bob" / FILE)
    students = found(path)
    with pytest.raises(UsageError, match="eve holds no"):
        students["eve"].read()
    with pytest.raises(RefusedError, match="link"):
        students["mallory"].read()


@pytest.mark.parametrize("form", ["folder", "zip", "zip of a folder", "folder in a folder"])
def test_who_handed_in_an_empty_folder_is_not_forgotten(found, tmp_path, form):
    top = tmp_path / "hand" / "Lab 3"
    for student in ("alice", "bob", "carol"):
        (top / student).mkdir(parents=True)
        if student != "carol":
            (top / student / FILE).write_bytes(NODE)
    path = top if form in ("folder", "zip") else top.parent
    if "zip" in form:
        path = zipped(path, tmp_path / "class.zip")
    submissions = found(path)
    assert sorted(submissions) == ["alice", "bob", "carol"]
    with pytest.raises(UsageError, match=f"carol holds no {FILE}"):
        submissions["carol"].read()


def test_one_unsafe_name_in_the_zip_of_a_class_is_not_the_loss_of_others(found, tmp_path):
    with zipfile.ZipFile(tmp_path / "class.zip", "w") as archive:
        archive.writestr(f"bob/{FILE}", NODE)
        archive.writestr(f"eve/../../{FILE}", NODE)
        archive.writestr(f"mallory/{FILE}", NODE)
        link = zipfile.ZipInfo("mallory/link")
        link.external_attr = (stat.S_IFLNK | 0o777) << 16
        archive.writestr(link, "/etc/passwd")
    students = found(tmp_path / "class.zip")
    assert students["bob"].read().files == {FILE: NODE}
    for name in ("eve", "mallory"):
        with pytest.raises(RefusedError):
            students[name].read()


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=60)
@given(st.lists(st.text(min_size=1, max_size=30).filter(lambda name: "\0" not in name), min_size=1, unique=True))
def test_whatever_the_names_in_a_zip_every_student_is_one(exercise, tmp_path, names):
    path = tmp_path / "class.zip"
    with zipfile.ZipFile(path, "w") as archive:
        for name in names:
            archive.writestr(f"{name}/{FILE}", NODE)
    with ExitStack() as stack:
        try:
            submissions, _ = find_submissions(path, exercise, stack)
        except UsageError:
            return
        labels = [each.student.casefold() for each in submissions]
        assert len(set(labels)) == len(labels)
        assert all(each.student.isprintable() for each in submissions)
        for each in submissions:
            try:
                each.read()
            except UsageError as error:
                assert str(error).isprintable()
