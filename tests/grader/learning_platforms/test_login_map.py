"""Whose a login of GitHub is: maps as people and GitHub Classroom write them, and wrong ones."""

import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.learning_platforms.login_map import Person, of_repositories, read_login_map


@pytest.fixture
def read(tmp_path):
    def look(text, encoding="utf-8"):
        (tmp_path / "map.csv").write_text(text, encoding=encoding)
        return read_login_map(tmp_path / "map.csv")

    return look


def test_a_map_of_two_columns(read):
    assert read("login,student\nJDoe,Jane Doe\n\nroe,Al\n") == {
        "jdoe": Person("JDoe", "Jane Doe", ""),
        "roe": Person("roe", "Al", ""),
    }


def test_the_roster_of_github_classroom_and_a_spreadsheet(read):
    head = '"identifier","github_username","github_id","name"\n'
    roster = head + '"k1","jdoe","1","Jane Doe"\n"k2","","",""\n"k3","roe","3",""\n'
    assert read(roster) == {"jdoe": Person("jdoe", "Jane Doe", "k1"), "roe": Person("roe", "k3", "k3")}
    assert read("Student;Login\nJane;jdoe\n", "utf-8-sig") == {"jdoe": Person("jdoe", "Jane", "")}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("login,student\na,A\nb,B\nA,C\n", ["line 4", "the login 'A' is on line 2, too"]),
        ("login,student\na,Ada\nb,ada\n", ["line 3", "the student 'ada' is on line 2, too"]),
        ("login,student\na,\n", ["line 2", "'a' has no student"]),
        ("login,studnet\na,A\n", ["line 1", "login and student", "'studnet'"]),
        ("name,x\na,b\n", ["line 1", "login and student"]),
        ("login,student\n", ["has no student"]),
    ],
)
def test_what_is_wrong_is_one_sentence_with_its_line(read, text, words):
    with pytest.raises(UsageError) as caught:
        read(text)
    assert [word for word in words if word not in str(caught.value)] == []
    assert "\n" not in str(caught.value)


def test_the_assignment_is_what_fits_most():
    people = {name: Person(name, name, "") for name in ("doe", "jane-doe", "al")}
    names = ("lab-doe", "lab-jane-doe", "lab-al", "lab-al-1", "other")
    assert {name: each.login for name, each in of_repositories(names, people).items()} == {
        "lab-doe": "doe",
        "lab-jane-doe": "jane-doe",
        "lab-al": "al",
    }
    assert of_repositories(("lab-x",), people) == {}


def test_a_login_twice_ends_the_command_before_anything_is_written(course, tmp_path):
    (tmp_path / "class/03-teleop-a").mkdir(parents=True)
    (tmp_path / "class/03-teleop-a/teleop_node.py").write_text("x = 1\n")
    (tmp_path / "map.csv").write_text("\ufefflogin;student\na;A\na;B\n", encoding="utf-8")
    told = course("grade-all", "03", tmp_path / "class", "--out", tmp_path / "out", "--map", tmp_path / "map.csv")
    assert told.code == 2 and "line 3: the login 'a' is on line 2, too" in " ".join(told.stderr.split())
    assert not (tmp_path / "out").exists()
