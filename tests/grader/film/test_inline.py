"""A recording as the value of a notebook's cell: page, words and picture; the viewer ends with the process."""

import io
import urllib.request

import psutil
import pytest
from PIL import Image

from gz_course.grader.errors import UsageError
from gz_course.grader.film.inline import PAGES, STILL, recording_frame
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.record.scene import shape


def test_a_frame_of_a_recording(tmp_path):
    path = tmp_path / "run.rrd"
    with Recorder(path, "robot") as recorder:
        recorder.static("/world/robot/base/visual", shape("box", [1, 1, 1], [1, 0, 0, 1]))
        recorder.pose("/world/robot", (0, 0, 0.5), (1, 0, 0, 0))
        recorder.properties("run", exercise="made", submission="node.py", robot="robot")
    try:
        frame = recording_frame(path, 0.0)
        again = recording_frame(str(path), 0.0)
        viewer = PAGES._viewer._process.pid
        assert frame.address == again.address, "one viewer and one server for all cells"
        with urllib.request.urlopen(frame.address, timeout=120) as page:
            assert b"Rerun" in page.read()
    finally:
        PAGES.close()
    assert not psutil.pid_exists(viewer)
    assert frame.words == "Recording of made, node.py"
    assert Image.open(io.BytesIO(frame.still)).size == STILL
    with pytest.raises(UsageError, match="no recording at"):
        recording_frame(tmp_path / "none.rrd")
