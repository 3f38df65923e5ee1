"""Which lines of the output were logged: each message on /rosout stands for one line of the same text."""

from types import SimpleNamespace

from gz_course.grader.run.console_log import ConsoleLog

INFO, ERROR = 20, 40


def log(name, text, level=INFO):
    return SimpleNamespace(level=level, name=name, msg=text)


def test_a_line_may_come_before_its_message_or_after_it():
    console = ConsoleLog("", 100, "")
    console.message(log("a", "early"))
    for line in ("[INFO] [a]: early", "printed", "[ERROR] [a.b]: late"):
        console.line(line)
    console.message(log("a.b", "late", ERROR))
    assert console.not_logged() == []


def test_what_looks_logged_and_never_was_is_numbered():
    console = ConsoleLog("", 100, "")
    for line in ("[INFO] [a]: once", "[INFO] [a]: once", "printed", "[WARN] [a]: once"):
        console.line(line)
    console.message(log("a", "once"))
    assert console.not_logged() == [1, 3]


def test_texts_are_compared_as_they_are_shown():
    console = ConsoleLog("/tmp/course-1/submission", 30, "/submission")
    console.message(log("a", "/tmp/course-1/submission/x\n[INFO] [a]: " + "y" * 50))
    console.line("[INFO] [a]: /submission/x")
    console.line("[INFO] [a]: " + "y" * 18)
    assert console.not_logged() == []
