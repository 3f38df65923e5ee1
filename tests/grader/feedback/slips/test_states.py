"""States that are asked for and never set."""

from gz_course.grader.feedback.slips import slips

TEXT = """
class Robot:
    def __init__(self):
        self.mode = "LOOK"

    def plan(self):
        self.mode = "GO"

    def drive(self):
        if self.mode == "LOOK":
            self.turn()
        elif self.mode == "DRIVE":
            self.go()
"""


def test_a_state_that_is_never_set_is_found():
    (place,) = slips(TEXT.encode())
    assert place["line"] == 12 and "never 'DRIVE', so this condition never holds" in place["said"]


def test_a_state_that_is_set_is_not():
    assert slips(TEXT.replace("DRIVE", "GO").encode()) == []
    assert slips(TEXT.replace('self.mode = "GO"', "self.mode = choose()").encode()) == []
    assert slips(TEXT.replace('== "DRIVE"', '!= "DRIVE"').encode()) == []
    assert slips((TEXT + '\nrobot.mode = "DRIVE"\n').encode()) == []
