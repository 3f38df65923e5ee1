"""What instructors change by hand counts, is said, and no run loses it; what is wrong is one sentence with its line."""

import csv
import json

import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.whole_class.final import BY_HAND, Final
from gz_course.grader.whole_class.overrides import OVERRIDES, read_overrides
from gz_course.grader.whole_class.overview import write_overview

STUDENTS = {"Ada Lovelace": "17", "linus": "", "Jane": "4"}
HEAD = "student,exercise,check,points,comment,excuse,deadline,by\n"


@pytest.fixture
def overrides(tmp_path):
    def write(*lines, head=HEAD, encoding="utf-8"):
        (tmp_path / OVERRIDES).write_text(head + "".join(f"{line}\n" for line in lines), encoding=encoding)
        return tmp_path

    return write


def graded(exercise, student, **failed):
    points = {each.id: failed.get(each.id, each.points) for each in exercise.checks}
    return {
        "student": student, "id": STUDENTS[student], "submission": student, "score": sum(points.values()),
        "points": points, "outcome": "graded", "diagnosis": "It never stops.", "sha256": "s", "truth_sha256": "t",
        "folder": student.lower().replace(" ", "_"), "platform": "",
    }  # fmt: skip


def final(exercise, folder, *results):
    rules = Final(exercise, folder, [(each["student"], each["id"]) for each in results])
    return {each["student"]: each for each in rules.results(results)}


def test_without_a_file_nothing_changes(exercise, tmp_path):
    result = final(exercise, tmp_path, graded(exercise, "linus", stops=0))["linus"]
    assert (result["score"], result["machine_score"], result["changes"]) == (80, 80, [])


def test_a_check_a_total_and_an_excuse(exercise, overrides):
    folder = overrides("17,,stops,12.5,the log shows it,,,Grace", "LINUS,,total,75,,,,", "Jane,,,,ill,yes,,")
    found = final(exercise, folder, *(graded(exercise, name, stops=0) for name in STUDENTS))
    assert found["Ada Lovelace"]["score"] == 92.5
    assert found["Ada Lovelace"]["changes"] == ["stops 0 -> 12.5 (by Grace: the log shows it)"]
    assert (found["linus"]["score"], found["linus"]["changes"]) == (75, ["total 80 -> 75"])
    assert (found["Jane"]["score"], found["Jane"]["outcome"]) == (None, "excused")
    assert found["Jane"]["changes"] == ["excused (ill)"]


def test_lines_of_other_exercises_and_empty_ones_are_left_alone(exercise, overrides):
    assert read_overrides(overrides("linus,04_lidar_listener,nothing,1000,,,,", ",,,,,,,"), exercise, STUDENTS) == []


def test_the_exercise_of_a_line_may_be_its_number_and_is_not_misspelt(exercise, overrides):
    assert len(read_overrides(overrides("linus,3,stops,5,,,,"), exercise, STUDENTS)) == 1
    with pytest.raises(UsageError, match=r"line 2: there is no exercise '03_telop'; did you mean '03_teleop'"):
        read_overrides(overrides("linus,03_telop,stops,5,,,,"), exercise, STUDENTS)


def test_a_spreadsheet_with_semicolons_a_mark_and_commas_in_numbers(exercise, overrides):
    folder = overrides("linus;stops;12,5", head="Student;Check;Points\n", encoding="utf-8-sig")
    (found,) = read_overrides(folder, exercise, STUDENTS)
    assert (found.student, found.check, found.points, found.line) == ("linus", "stops", 12.5, 2)


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (["linux,,stops,3,,,,"], "line 2: the class has no student 'linux'; did you mean 'linus'?"),
        (["linus,,stop,3,,,,"], "line 2: 03_teleop has no check 'stop'; did you mean 'stops'?"),
        (["linus,,stops,21,,,,"], "line 2: 21 points, but stops has 0 to 20"),
        (["linus,,,101,,,,"], "line 2: 101 points, but 03_teleop has 0 to 100"),
        (["linus,,,-1,,,,"], "line 2: -1 points"),
        (["linus,,,nan,,,,"], "line 2: nan points"),
        (["linus,,stops,many,,,,"], "line 2: 'many' is no number of points"),
        (["linus,,stops,,,,,"], "line 2: the check stops is named, but no points are given"),
        (["linus,,,,,perhaps,,"], "line 2: excuse is 'perhaps'"),
        (["linus,,,,,,tomorrow,"], "line 2: the deadline 'tomorrow' is no time"),
        (["linus,,stops,1,,,,", "linus,,stops,2,,,,"], "line 3: contradicts line 2; keep one of them"),
        (["linus,,,1,,,,", "linus,,stops,2,,,,"], "line 3: contradicts line 2, which gives all points at once"),
        (["linus,,,,,yes,,", "linus,,stops,2,,,,"], "line 3: contradicts line 2, which excuses linus"),
        (["linus,,stops,1,a,,,,,"], "line 2: more cells than columns"),
    ],
)
def test_what_is_wrong_is_one_sentence_with_its_line(exercise, overrides, lines, words):
    with pytest.raises(UsageError) as told:
        read_overrides(overrides(*lines), exercise, STUDENTS)
    assert words in str(told.value)
    assert len(str(told.value).splitlines()) == 1


@pytest.mark.parametrize("head", ["student,chek\n", "name,points\n", "student,student\n"])
def test_columns_that_are_not_known(exercise, overrides, head):
    with pytest.raises(UsageError, match="line 1: "):
        read_overrides(overrides("linus,stops", head=head), exercise, STUDENTS)


def test_gradebook_reports_and_page_say_it_and_forget_it_again(exercise, overrides, tmp_path):
    result = graded(exercise, "linus", stops=0)
    page = '<p>80 of 100</p>\n<p class="note" id="by-hand" hidden></p>\n<p>more</p>'
    (tmp_path / "linus").mkdir()
    (tmp_path / "linus/report.json").write_text(json.dumps({"score": 80}, indent=2) + "\n")
    (tmp_path / "linus/report.html").write_text(page)
    overrides("linus,,stops,20,<b>seen</b>,,,")
    for _ in range(2):
        write_overview(tmp_path, exercise, [result], ["html"])
        with (tmp_path / "gradebook.csv").open(newline="", encoding="utf-8-sig") as stream:
            (row,) = csv.DictReader(stream)
        assert (row["score"], row["machine_score"], row["stops"]) == ("100", "80", "20")
        assert row["changes"] == "stops 0 -> 20 (<b>seen</b>)"
        report = json.loads((tmp_path / "linus/report.json").read_text())
        assert report == {"score": 80, BY_HAND: {"score": 100, "changes": ["stops 0 -> 20 (<b>seen</b>)"]}}
        shown = (tmp_path / "linus/report.html").read_text()
        assert shown.count("Your grade: 100 points. stops 0 -&gt; 20 (&lt;b&gt;seen&lt;/b&gt;).") == 1
    (tmp_path / OVERRIDES).unlink()
    write_overview(tmp_path, exercise, [result], ["html"])
    assert (tmp_path / "linus/report.html").read_text() == page
    assert json.loads((tmp_path / "linus/report.json").read_text()) == {"score": 80}
