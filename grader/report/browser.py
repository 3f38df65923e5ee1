"""`python -m gz_course.grader.report.browser PAGE` opens a report in a browser and plays its run.

Without a terminal, without a screen and in continuous integration nobody is there to look: it says where the page is.
Not a part of `course grade`, which may live in a network of its own, where a browser cannot work.
"""

from __future__ import annotations

import os
import sys
import webbrowser
from pathlib import Path

PLAY = "#play"
SCREENS = ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")


def main() -> int:
    if len(sys.argv) != 2:
        print("usage: python -m gz_course.grader.report.browser PAGE", file=sys.stderr)
        return 2
    page = Path(sys.argv[1])
    watched = sys.stdout.isatty() and not os.environ.get("CI") and any(map(os.environ.get, SCREENS))
    opened = watched and webbrowser.open(page.resolve().as_uri() + PLAY)
    print(f"{'The robot drives in your browser' if opened else 'Watch the robot drive, in a browser'}: {page}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
