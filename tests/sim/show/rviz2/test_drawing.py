"""Messages of every type on a canvas: what Rerun gets of them, and that none breaks the view."""

import math
from array import array

import numpy as np
import pytest
import rerun as rr
from rerun.chunk import RrdReader

from gz_course.sim.show.rviz2.canvas import Canvas
from gz_course.sim.show.rviz2.drawing import drawn_types
from gz_course.sim.show.rviz2.drawing.fields import plot
from gz_course.sim.show.rviz2.layout import layout


class Drawn:
    """A canvas on a file, and what is in the file."""

    def __init__(self, path):
        self._path = path
        self.said = []
        self.stream = rr.RecordingStream("test", send_properties=False)
        self.stream.save(path)
        self.canvas = Canvas(self.stream, self.said.append)

    def draw(self, topic, kind, message):
        self.canvas.begin()
        drawn_types().get(kind, plot)(self.canvas, topic, message)

    def columns(self):
        """Return the values of each entity and component, of the last row."""
        self.stream.disconnect()
        found = {}
        for chunk in RrdReader(self._path).stream():
            batch = chunk.to_record_batch()
            for name in batch.schema.names:
                if ":" in name:
                    found[chunk.entity_path, name.partition(":")[2]] = batch.column(name).to_pylist()[-1]
        return found


@pytest.fixture
def drawn(tmp_path):
    made = Drawn(tmp_path / "drawn.rrd")
    yield made
    made.stream.disconnect()


def header(frame):
    from std_msgs.msg import Header

    return Header(frame_id=frame)


def test_a_scan_an_odometry_and_a_transform_are_in_one_tree(drawn):
    from geometry_msgs.msg import Quaternion, TransformStamped
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import LaserScan
    from tf2_msgs.msg import TFMessage

    scan = LaserScan(header=header("lidar"), angle_increment=math.pi / 2, ranges=[1.0, math.inf, 2.0])
    for x in (1.0, 2.0):
        odometry = Odometry(header=header("odom"), child_frame_id="base")
        odometry.pose.pose.position.x = x
        odometry.twist.twist.linear.x = 0.3
        drawn.canvas.now += 1.0
        drawn.canvas._due.clear()
        drawn.draw("/odom", "nav_msgs/msg/Odometry", odometry)
    drawn.draw("/scan", "sensor_msgs/msg/LaserScan", scan)
    assert drawn.said == ["no transform to the frame lidar is known; what is in it is drawn at base"]
    link = TransformStamped(header=header("base"), child_frame_id="lidar")
    link.transform.translation.z, link.transform.rotation = 0.5, Quaternion(w=1.0)
    drawn.draw("/tf", "tf2_msgs/msg/TFMessage", TFMessage(transforms=[link]))
    found = drawn.columns()
    assert np.round(found["/scan", "positions"], 6).tolist() == [[1, 0, 0], [-2, 0, 0]]
    assert found["/scan", "frame"] == ["lidar"]
    tree = {child: found[f"/tf/{child}", "parent_frame"][0] for child in ("odom", "base", "lidar")}
    assert tree == {"odom": "tf#/", "base": "odom", "lidar": "base"}
    assert found["/tf/lidar", "translation"] == [[0, 0, 0.5]] and found["/tf/base", "translation"] == [[2, 0, 0]]
    assert found["/odom/path", "strips"] == [[[1, 0, 0], [2, 0, 0]]]
    assert found["/plots/odom/twist/linear/x", "scalars"] == [0.3]


def test_pictures_clouds_maps_and_texts(drawn):
    from nav_msgs.msg import OccupancyGrid
    from rcl_interfaces.msg import Log
    from sensor_msgs.msg import Image, PointCloud2
    from std_msgs.msg import Header

    from gz_course.sim.ros.sensor_msgs_py.point_cloud2 import create_cloud_xyz32

    depth = np.array([[1.0, np.inf], [2.0, 3.0]], np.float32)
    picture = Image(encoding="32FC1", width=2, height=2, step=8, data=array("B", depth.tobytes()))
    drawn.draw("/depth", "sensor_msgs/msg/Image", picture)
    drawn.draw("/camera", "sensor_msgs/msg/Image", Image(encoding="rgb8", width=1, height=1, step=3, data=[1, 2, 3]))
    drawn.draw("/odd", "sensor_msgs/msg/Image", Image(encoding="yuv422", width=1, height=1, step=3, data=[1, 2, 3]))
    cloud = create_cloud_xyz32(Header(frame_id="c"), [(1, 2, 3), (math.nan, 0, 0)])
    drawn.draw("/cloud", "sensor_msgs/msg/PointCloud2", cloud)
    drawn.draw("/empty", "sensor_msgs/msg/PointCloud2", PointCloud2())
    grid = OccupancyGrid(header=header("map"), data=[0, 100, -1, 7])
    grid.info.width, grid.info.height, grid.info.resolution = 2, 2, 0.5
    drawn.draw("/map", "nav_msgs/msg/OccupancyGrid", grid)
    drawn.draw("/rosout", "rcl_interfaces/msg/Log", Log(name="node", msg="hello", level=40))
    assert drawn.said == [
        "/odd: pictures of the encoding yuv422 are not drawn",
        "/empty: a cloud without x, y and z is not drawn",
    ]
    assert drawn.canvas.pictures == ["/depth", "/camera"]
    found = drawn.columns()
    assert np.frombuffer(bytes(found["/depth", "buffer"][0]), np.float32).tolist() == [1, 0, 2, 3]
    assert bytes(found["/camera", "blob"][0])[:2] == b"\xff\xd8"
    assert found["/cloud", "positions"] == [[1, 2, 3]]
    assert bytes(found["/map", "data"][0]) == bytes([255, 7, 0, 100]), "the first row of a map is the lowest"
    assert (found["/log/rosout", "text"], found["/log/rosout", "level"]) == (["[node] hello"], ["ERROR"])


def test_markers_come_and_go(drawn):
    from geometry_msgs.msg import Point
    from visualization_msgs.msg import Marker, MarkerArray

    def marker(number, kind, action=Marker.ADD):
        made = Marker(header=header("map"), ns="n", id=number, type=kind, action=action)
        made.scale.x, made.scale.y, made.scale.z, made.color.a = 1.0, 2.0, 3.0, 1.0
        made.points = [Point(x=float(n)) for n in range(3)]
        return made

    all_kinds = [marker(kind, kind) for kind in range(12)]
    drawn.draw("/m", "visualization_msgs/msg/MarkerArray", MarkerArray(markers=all_kinds))
    drawn.draw("/m", "visualization_msgs/msg/Marker", marker(Marker.CUBE, Marker.CUBE, Marker.DELETE))
    assert drawn.said == ["/m: markers of type 10 are not drawn"], "meshes of other packages"
    found = drawn.columns()
    assert found["/m/n/2", "half_sizes"] == [[0.5, 1.0, 1.5]]
    assert found["/m/n/2", "frame"] == ["/m/n/2".lstrip("/")]
    assert found["/m/n/1", "is_recursive"] == [True] and ("/m/n/3", "is_recursive") not in found


def test_every_common_message_can_be_shown(drawn):
    import geometry_msgs.msg
    import nav_msgs.msg
    import sensor_msgs.msg
    import std_msgs.msg
    import visualization_msgs.msg

    count = 0
    for package in (geometry_msgs.msg, nav_msgs.msg, sensor_msgs.msg, std_msgs.msg, visualization_msgs.msg):
        for name, kind in vars(package).items():
            if isinstance(kind, type):
                count += 1
                drawn.draw(f"/{name}", f"{package.__name__.replace('.', '/')}/{name}", kind())
    assert count > 100


def test_the_layout_has_a_view_for_each_picture_and_the_chosen_plots():
    made = layout(["/topics/a", "/topics/b"], ["/odom/twist/linear/x"], "map")
    world, beside = made.root_container.contents
    assert world.name == "World, in map"
    pictures, plots, log = beside.contents
    assert [each.name for each in pictures.contents] == ["/a", "/b"]
    assert plots.contents == ["/plots/odom/twist/linear/x"] and log.name == "Log"
    assert layout([]).root_container.contents[1].contents[0].contents == ["/plots/**"]
