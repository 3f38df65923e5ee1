"""The page on where to grade: its commands have the options that it names, and its links lead somewhere."""

import re
from pathlib import Path

from gz_course.grader.course import Commands

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "where_to_grade.md").read_text()


def test_commands_have_their_options():
    called = re.findall(r"(?:^    |`)course ([a-z-]+)([^`\n]*)", PAGE, re.M)
    assert {"export", "package", "grade", "grade-all"} <= {name for name, _ in called}
    for name, rest in called:
        options = {option for each in Commands(name="course").get_command(None, name).params for option in each.opts}
        assert set(re.findall(r"--[a-z-]+", rest)) <= options, name
    assert {"--for", "--hidden", "--roster", "--out"} <= set(re.findall(r"--[a-z-]+", PAGE))
    export = {option for each in Commands(name="course").get_command(None, "export").params for option in each.opts}
    assert export - set(re.findall(r"--[a-z-]+", PAGE)) <= {"exercise", "grades", "--help"}, "every option is explained"


def test_links_lead_somewhere():
    for target in re.findall(r"\]\(([^)#]+)[^)]*\)", PAGE):
        assert target.startswith("https://") or (ROOT / "docs" / target).exists(), target
    headings = {
        re.sub(r"[^\w -]", "", line).strip().lower().replace(" ", "-") for line in re.findall(r"^#+ (.*)", PAGE, re.M)
    }
    assert set(re.findall(r"\]\(#([^)]+)\)", PAGE)) <= headings
