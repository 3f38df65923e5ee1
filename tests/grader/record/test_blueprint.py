"""How a recording opens: on the robot's track, at a time at which everything is there, with the failure marked."""

import pytest
from rerun.chunk import RrdReader

from gz_course.grader.record.recorder import Recorder
from gz_course.grader.record.scene import Scene
from gz_course.sim.gz.sim.world import World

WORLD = """<sdf version='1.11'><world name='w'><model name='robot'><pose>3 4 0.5 0 0 0</pose><link name='l'>
<visual name='v'><geometry><box><size>1 1 1</size></box></geometry></visual></link></model></world></sdf>"""


def layouts(path):
    """The components of each layout in a recording, by the last part of their entity."""
    reader = RrdReader(path)
    for store in reader.blueprints():
        found = {}
        for chunk in reader.stream(store=store):
            batch = chunk.to_record_batch()
            for name in batch.schema.names:
                if ":" in name:
                    found[chunk.entity_path.rpartition("/")[2], name.partition(":")[2]] = batch.column(name)[0].as_py()
        yield found


def test_the_layout_tells_the_story_of_the_run(tmp_path):
    with Recorder(tmp_path / "run.rrd", "robot") as recorder:
        for x in (0.0, 8.0):
            recorder.pose("/world/robot", (x, 2.0, 0.0), (1, 0, 0, 0))
            recorder.pose("/world/other", (100.0, 2.0, 0.0), (1, 0, 0, 0))
        recorder.title("Drive: teleop.py")
        recorder.tell_story([6.5, 2.5])
    found = [each for each in layouts(tmp_path / "run.rrd") if ("time_panel", "time_selection") in each]
    assert len(found) == 1
    layout = found[0]
    assert layout["time_panel", "time_selection"] == [{"min": 2_500_000_000, "max": 3_000_000_000}]
    assert layout["EyeControls3D", "look_target"] == [pytest.approx([4, 2, 0])]
    x, y, z = layout["EyeControls3D", "position"][0]
    assert x < 0 and y < 2 and z > 4, "far enough away for all of the track"
    (name,) = {
        chunk.to_record_batch().column("RecordingInfo:name")[0].as_py()[0]
        for chunk in RrdReader(tmp_path / "run.rrd").stream()
        if "RecordingInfo:name" in chunk.to_record_batch().schema.names
    }
    assert name == "Drive: teleop.py"


def test_without_a_failure_nothing_is_marked(tmp_path):
    with Recorder(tmp_path / "run.rrd", "robot") as recorder:
        recorder.tell_story([])
    assert not any(("time_panel", "time_selection") in each for each in layouts(tmp_path / "run.rrd"))


def test_at_time_0_everything_is_where_it_is(tmp_path):
    from sensor_msgs.msg import LaserScan

    from gz_course.grader.record.reading import Recording

    with Recorder(tmp_path / "run.rrd", "robot") as recorder:
        scene = Scene(recorder, World.from_string(WORLD))
        scene._lidars["/scan"] = "/world/robot/l/lidar/scan"
        for now in (10_000_000, 110_000_000):
            recorder.set_time(now)
            scene.scan("/scan", LaserScan(ranges=[now / 1e7]))
    recording = Recording(tmp_path / "run.rrd")
    poses = recording.poses("world/robot")
    assert poses.times.tolist() == [0] and poses.positions.tolist() == [pytest.approx([3, 4, 0.5])]
    assert recording.poses("world/robot/l").times.tolist() == [0]
    at = [recording.points_at("world/robot/l/lidar/scan", time)[0, 0] for time in (0, 10_000_000, 110_000_000)]
    assert at == pytest.approx([1, 1, 11])
    assert not recording.has("truth/robot/x"), "the truth begins with the first tick"
