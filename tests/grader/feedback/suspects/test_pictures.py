"""Pictures whose shape, indices or middle are taken for something else."""

import pytest

from gz_course.grader.feedback.suspects import suspects


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("width, height, _ = colours.shape", "the height for the width"),
        ("w, h = depth.shape[:2]", "the height for the width"),
        ("self.width = colours.shape[0]", "(height, width, channels)"),
        ("picture = bridge.imgmsg_to_cv2(depth)\nahead = picture[column, row]", "the row comes first"),
        ("columns, rows = np.nonzero(self.red_mask(colours))", "nonzero() returns the rows first"),
        ("xs, ys = numpy.where(red > 50)", "where() returns the rows first"),
        ("self.middle = message.height / 2", "made of the height"),
        ("view = bridge.imgmsg_to_cv2(image)[:, 40:]", "begins at column 40 of the picture"),
        ("picture = bridge.imgmsg_to_cv2(image)\nview = picture[20:100, 10:150]", "view begins at column 10"),
        ("self.fx, self.cx = message.k[0], message.k[5]", "the middle row"),
    ],
)
def test_wrong(line, words):
    found = suspects(line.encode())
    assert [each["about"] for each in found] == ["picture"] and words in found[0]["said"], found


@pytest.mark.parametrize(
    "line",
    [
        "height, width, _ = colours.shape",
        "h, w = depth.shape[:2]",
        "rows, columns = np.nonzero(mask)",
        "columns, rows = np.nonzero(mask.T)",
        "w, h = depth.shape[1::-1]",
        "w, h = depth.T.shape",
        "self.width = colours.shape[1]",
        "picture = bridge.imgmsg_to_cv2(depth)\nahead = picture[row, column]",
        "self.middle = message.width / 2",
        "view = bridge.imgmsg_to_cv2(image)[40:, :]",
        "view = bridge.imgmsg_to_cv2(image)[:, 40:]\ncolumn = np.nonzero(view)[1].mean() + 40",
        "self.fx, self.cx, self.cy = message.k[0], message.k[2], message.k[5]",
    ],
)
def test_right(line):
    assert suspects(line.encode()) == []
