"""Pictures and films of a small recording made by hand: what is in them, and the sentence for what cannot be made."""

import json
import sys

import numpy as np
import pytest
from PIL import Image

from gz_course.grader.errors import UsageError
from gz_course.grader.film.film import film, size_of, snapshot
from gz_course.grader.film.picture import Pictures
from gz_course.grader.record.reading import Recording
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.record.scene import shape, surface

SIZE = (160, 120)


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    path = tmp_path_factory.mktemp("film") / "run.rrd"
    with Recorder(path, "robot") as recorder:
        recorder.static("/world/ground/link/visual", shape("plane", [0, 0, 0], [0.8, 0.8, 0.8, 1]))
        recorder.static("/world/robot/base/visual", shape("box", [1, 1, 1], [1, 0, 0, 1]))
        for kind in ("cylinder", "capsule", "sphere"):
            recorder.static(f"/world/far/{kind}/visual", shape(kind, [0.1, 0.1, 0.1], [0, 0, 1, 1]))
        corners, faces = np.array([[0, 0, 9], [1, 0, 9], [0, 1, 9.0], [0, 0, 10]]), [[0, 1, 2], [0, 3, 1]]
        recorder.static("/world/far/mesh/visual", surface(corners, [*faces, [0, 2, 3], [1, 3, 2]], [1] * 4))
        for second in (0, 1, 2):
            recorder.set_time(second * 10**9)
            recorder.pose("/world/robot", (0.5 * second, 0, 0.5), (1, 0, 0, 0))
            recorder.points("/world/robot/base/scan", np.array([[0.0, 0.0, 0.6]]))
        recorder.text("log/verdicts", "Stops: failed; it did not", "ERROR")
        recorder.properties("run", exercise="made", submission="node.py", robot="robot", facts=json.dumps({}))
    return Recording(path)


def pixels(path):
    return np.asarray(Image.open(path).convert("RGB")).astype(int)


def test_the_camera_follows_the_robot_and_the_picture_is_the_same_each_time(recording, tmp_path):
    paths = [tmp_path / f"{name}.png" for name in ("early", "again", "late")]
    for path, at in zip(paths, (0.0, 0.0, 2.0), strict=True):
        snapshot(recording, at, path, SIZE)
    early, late = pixels(paths[0]), pixels(paths[2])
    assert early.shape == (120, 160, 3)
    for picture in (early, late):
        red = (picture[..., 0] > picture[..., 1] + 60) & (picture[..., 2] < 60)
        rows, columns = np.nonzero(red)
        assert len(rows) > 200 and abs(columns.mean() - 80) < 45, "the robot is in the middle"
    assert paths[0].read_bytes() == paths[1].read_bytes()
    assert (early != late).any()
    assert sorted(tmp_path.iterdir()) == sorted(paths), "nothing else is left"


def test_scan_and_path_are_drawn_where_they_are(recording):
    pictures = Pictures(recording, *SIZE)
    try:
        assert pictures._scan(10**9).tolist() == [[0.5, 0.0, pytest.approx(1.1)]]
        assert len(pictures._path(10**9)) == 2
        pictures.stage.image(0)
        at, seen = pictures.stage.project(np.array([[0.0, 0, 0.5], [0, 0, 50.0]]))
        assert seen.tolist() == [False, False], "hidden in the box; out of the picture"
        eye, axes = pictures.stage.eye(0)
        at, seen = pictures.stage.project((eye + axes[:, 0])[None])
        assert seen.all() and at[0] == pytest.approx((80, pictures.stage.height / 2))
    finally:
        pictures.close()


def test_a_film_has_its_pictures_at_their_times(recording, tmp_path):
    told = []
    assert film(recording, tmp_path / "run.gif", SIZE, 2.0, progress=told.append) == 5
    with Image.open(tmp_path / "run.gif") as made:
        assert (made.n_frames, made.size, made.info["duration"]) == (5, SIZE, 500)
    assert told[-1] == 1.0


def test_an_mp4(recording, tmp_path):
    av = pytest.importorskip("av")
    assert film(recording, tmp_path / "run.mp4", (81, 65), 4.0, 1.0, 1.5) == 3
    with av.open(str(tmp_path / "run.mp4")) as file:
        assert sum(1 for _ in file.decode(video=0)) == 3


def test_without_the_extra_an_mp4_is_one_sentence(recording, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(UsageError, match=r"an MP4 needs PyAV: pip install 'gz-ros2-course\[video\]'"):
        film(recording, tmp_path / "run.mp4", SIZE, 1.0)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("at", "name", "sentence"),
    [
        (3.0, "a.png", "--at 3 is outside of the recording, which goes from 0 to 2 s"),
        (float("nan"), "a.png", "--at nan is outside"),
        (0.0, "a.bmp", "does not say what kind of picture it is; end its name with .png or .jpg or .jpeg"),
        (0.0, "nowhere/a.png", "cannot be written: there is no folder"),
    ],
)
def test_a_picture_that_cannot_be_made(recording, tmp_path, at, name, sentence):
    with pytest.raises(UsageError) as caught:
        snapshot(recording, at, tmp_path / name, SIZE)
    assert sentence in str(caught.value)


def test_a_film_that_cannot_be_made(recording, tmp_path):
    for wanted, sentence in (
        ({"start_s": 1.0, "end_s": 9.0}, "from 1 to 9 s is no part of the recording, which goes from 0 to 2 s"),
        ({"frames_per_second": 0.0}, "--fps must be between 1 and 60"),
        ({"size": (1, 1)}, "--size must be between 64x64 and 4096x4096, not 1x1"),
    ):
        with pytest.raises(UsageError, match=sentence):
            film(recording, tmp_path / "a.gif", **{"size": SIZE, "frames_per_second": 1.0} | wanted)
    with pytest.raises(UsageError, match="--size must be like 640x360, not 'big'"):
        size_of("big")
    assert size_of("640x360") == (640, 360)


def test_a_run_without_a_world(tmp_path):
    with Recorder(tmp_path / "run.rrd", "robot") as recorder:
        recorder.text("log/grader", "no such file", "ERROR")
    with pytest.raises(UsageError, match="holds no world: nothing was simulated in this run"):
        snapshot(Recording(tmp_path / "run.rrd"), 0.0, tmp_path / "a.png", SIZE)


def test_a_run_without_the_robot_of_the_exercise(tmp_path):
    with Recorder(tmp_path / "run.rrd", "robot") as recorder:
        for model, speed in (("slow", 0.0), ("fast", 1.0)):
            recorder.static(f"/world/{model}/base/visual", shape("box", [1, 1, 1], [1, 0, 0, 1]))
            for second in (0, 1):
                recorder.set_time(second * 10**9)
                recorder.pose(f"/world/{model}", (speed * second, 5, 0.5), (1, 0, 0, 0))
        recorder.properties("run", robot="robot")
    pictures = Pictures(Recording(tmp_path / "run.rrd"), *SIZE)
    assert pictures.stage.robot == "fast" and len(pictures._path(10**9)) == 2
    pictures.close()
