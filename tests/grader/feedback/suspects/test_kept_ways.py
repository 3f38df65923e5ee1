"""Robots that do not keep to their way, frontiers that no cell is, walls that become free again, and whole turns."""

import pytest

from gz_course.grader.feedback.suspects import suspects

NODE = """\
class Mapper(Node):
    def __init__(self):
        self.maps = self.create_publisher(OccupancyGrid, "/map", 10)

    def work(self):
        CODE
"""


def said(code, about):
    source = NODE.replace("CODE", code.replace("\n", "\n        "))
    return " ".join(each["said"] for each in suspects(source.encode()) if each["about"] == about)


ERASED = "grid[self.hits > 0] = OCCUPIED\ngrid[self.passes > 0] = FREE"
DISTANCE = "for cell in self.path:\n    if math.dist(cell, here) > 1.5:\n        return cell"
SQUARE = "for dx in range(-6, 7):\n    for dy in range(-6, 7):\n        blocked.discard((x + dx, y + dy))"


@pytest.mark.parametrize(
    ("code", "about", "found"),
    [
        ("if self.path:\n    pass\nelse:\n    twist.linear.x = 0.3", "blind", True),
        ("if not self.path:\n    twist.linear.x = 0.3", "blind", True),
        ("if way is None:\n    twist.linear.x = 0.3", "blind", True),
        ("if len(self.path) > 1 and ready:\n    pass\nelse:\n    twist.linear.x = 0.3", "blind", True),
        ("if self.path:\n    twist.linear.x = 0.3", "blind", False),
        ("if not self.path:\n    twist.linear.x = 0.0\n    twist.angular.z = 0.5", "blind", False),
        (DISTANCE, "far_aim", True),
        (DISTANCE.replace("1.5", "0.4"), "far_aim", False),
        ("aim = self.path[min(15, len(self.path) - 1)]", "far_aim", True),
        ("aim = self.path[min(4, len(self.path) - 1)]", "far_aim", False),
        (SQUARE, "left_out_walls", True),
        (SQUARE.replace("-6, 7", "-2, 3"), "left_out_walls", False),
        (SQUARE.replace("discard", "add"), "left_out_walls", False),
        ("near[row - 5 : row + 6, column - 5 : column + 6] = False", "left_out_walls", True),
        ("near[row - 2 : row + 3, column - 2 : column + 3] = False", "left_out_walls", False),
        ("return all(self.value(c) == -1 for c in beside)", "way", True),
        ("return any(self.value(c) == -1 for c in beside)", "way", False),
        ("return not all(self.value(c) == -1 for c in beside)", "way", False),
        ("return a[0] == UNKNOWN and a[1] == UNKNOWN and a[2] == UNKNOWN and a[3] == UNKNOWN", "way", True),
        (ERASED, "erased", True),
        ("\n".join(ERASED.split("\n")[::-1]), "erased", False),
        ("grid[self.odds > 0] = 100\ngrid[self.odds < 0] = 0", "erased", False),
        ("grid[self.hits > self.passes] = 100\ngrid[self.passes >= self.hits] = 0", "erased", False),
        ("error = (math.atan2(dy, dx) - self.yaw) % (2 * math.pi)", "wrap", True),
        ("error = np.mod(math.atan2(dy, dx) - self.yaw, 2 * np.pi)", "wrap", True),
        ("error = (math.atan2(dy, dx) - self.yaw + math.pi) % (2 * math.pi) - math.pi", "wrap", False),
        (
            "error = (atan2(dy, dx) - self.yaw) % (2 * pi)\nif error > pi:\n    error = error - 2 * pi",
            "wrap",
            False,
        ),
    ],
)
def test_what_leads_a_robot_astray(code, about, found):
    assert bool(said(code, about)) == found
