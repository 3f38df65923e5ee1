"""Gradebooks and rosters made by hand, and what Moodle and Canvas do with a file, as their importers are written."""

import csv
import io

from gz_course.grader.whole_class.gradebook import Row

CANVAS_HEAD = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "Teleop (4711)", "Current Score"]
WORKSHEET_HEAD = [
    "Identifier", "Full name", "Email address", "Status", "Grade", "Maximum Grade", "Grade can be changed",
    "Last modified (submission)", "Last modified (grade)", "Feedback comments",
]  # fmt: skip
MOODLE_HEAD = ["First name", "Last name", "ID number", "Email address", "Course total"]


def row(student, id="", submission=None, score=80.0, **more):
    facts = {"max_score": 100.0, "outcome": "graded", "diagnosis": ""} | more
    return Row(student, id, submission if submission is not None else student, score, **facts)


def table(*rows, delimiter=","):
    text = io.StringIO()
    csv.writer(text, delimiter=delimiter, lineterminator="\r\n").writerows(rows)
    return text.getvalue()


def parsed(text):
    return list(csv.reader(io.StringIO(text, newline="")))


def imported_by_canvas(text, ids):
    """Return Canvas ID -> grade, and the points of the assignment, as Canvas reads a file for students with `ids`.

    Source: Canvas, `lib/gradebook_importer.rb`.
    """
    head, *rows = parsed(text)
    assert "Student" in head[0] and "ID" in head[1], "a header row"
    assert len(head) > 3 and head[4] == "Section"
    assert len(head) == 6, "one assignment, and no column that would become another"
    points, grades = None, {}
    for cells in rows:
        assert len(cells) == len(head)
        if "Points Possible" in cells[0]:
            assert points is None
            points = cells[5]
        else:
            assert int(cells[1]) in ids, "the student is found by the ID"
            grades[int(cells[1])] = cells[5].strip()
    return grades, points


def imported_by_moodle(text, by, people, grade):
    """Return identifier -> (grade, feedback), as Moodle reads a file for `people`, mapping from the column `by`.

    Source: Moodle, `grade/import/csv/classes/load_data.php`.
    """
    head, *rows = parsed(text)
    assert len(set(head)) == len(head)
    who, what, why = head.index(by), head.index(grade), head.index(f"{grade} (Feedback)")
    grades = {}
    for cells in rows:
        assert len(cells) == len(head), "Moodle refuses the whole file"
        cells = [each.strip() for each in cells]
        assert cells[who], "an empty identifier would get the grade of the student before"
        assert cells[who] in people, "Moodle refuses the whole file for one unknown student"
        assert cells[who] not in grades
        float(cells[what])
        grades[cells[who]] = cells[what], cells[why]
    return grades


def feedback_taken_by_moodle(names, participants):
    """Return participant -> the files that Moodle stores from a zip with these names.

    Source: Moodle, `mod/assign/feedback/file/importziplib.php`, `is_valid_filename_for_import`.
    """
    stored = {}
    for name in names:
        parts = name.split("/")
        assert not parts[-1].startswith((".", "~"))
        while parts:
            info = parts.pop(0).split("_", 4)
            if len(info) < 4 or not info[1].isdigit() or int(info[1]) not in participants:
                continue
            assert info[2:4] == ["assignsubmission", "file"], "a plugin of the assignment"
            stored.setdefault(int(info[1]), []).append("/".join([*info[4:], *parts]).lstrip("/"))
            break
    return stored


def comments_taken_by_canvas(names, attachments):
    """Return user -> attachment, as Canvas reads the names of a zip; `attachments` are those of its submissions.

    Source: Canvas, `infer_comment_context_from_filename`.
    """
    found = {}
    for name in names:
        user, attachment = [part for part in name.split("_") if part.isdigit()][:2]
        assert attachments[int(user)] == int(attachment)
        found[int(user)] = int(attachment)
    return found
