"""Colours between 0 and 1 that are compared with numbers of 8 bits."""

import pytest

from gz_course.grader.feedback.slips import slips

NODE = """
class A:
    def on_image(self, image):
        colours = {made}
        self.look(colours)

    def look(self, picture):
        red, green, blue = picture[..., 0], picture[..., 1], picture[..., 2]
        return {test}
"""
PICTURE = 'self.bridge.imgmsg_to_cv2(image, "rgb8")'


@pytest.mark.parametrize(
    ("made", "test", "found"),
    [
        (f"{PICTURE} / 255", "(red > 50) & (red > 2 * green)", True),
        (f"{PICTURE}.astype(float) / 255.0", "100 <= picture[:, :, 0]", True),
        (f"({PICTURE} / 255).astype(np.float32)", "red >= 128", True),
        (f"{PICTURE} / 255", "(red > 0.2) & (red > 2 * green)", False),
        (f"{PICTURE}.astype(int)", "red > 50", False),
        (f"{PICTURE} / 255 * 100", "red > 50", False),
        (f"{PICTURE} / 255", "red < 50", False),
        ("self.speed / 255", "red > 50", False),
    ],
)
def test_shares_of_255(made, test, found):
    for name in ("picture", "colours"):
        places = slips(NODE.format(made=made, test=test).replace("picture", name).encode())
        assert ["never holds" in each["said"] for each in places] == [True] * found, places
