"""tf2 is imported by its own names; an installed package of such a name comes first."""

import os
import subprocess
import sys

IMPORTS = """
import tf2_geometry_msgs, tf2_py, tf2_ros, tf_transformations
from tf2_geometry_msgs.tf2_geometry_msgs import do_transform_point
from tf2_ros import LookupException, TransformException
from tf2_ros.buffer import Buffer
from tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster
from tf2_ros.transform_broadcaster import TransformBroadcaster
from tf2_ros.transform_listener import TransformListener
from tf2_geometry_msgs import Point, PointStamped, PolygonStamped, Pose, PoseStamped
from tf2_ros import Duration, Header, TFMessage, Time, TransformBroadcaster, TransformListener, TransformStamped
assert TransformStamped is tf2_geometry_msgs.TransformStamped is __import__("geometry_msgs.msg").msg.TransformStamped
assert Buffer is tf2_ros.Buffer and LookupException is tf2_py.LookupException
assert do_transform_point is tf2_geometry_msgs.do_transform_point
"""


def test_names_of_the_field():
    exec(IMPORTS, {})


def test_an_installed_package_comes_first(tmp_path):
    (tmp_path / "tf2_ros").mkdir()
    (tmp_path / "tf2_ros" / "__init__.py").write_text("WHOSE = 'theirs'\n")
    done = subprocess.run(
        [sys.executable, "-c", "import tf2_ros, tf_transformations; print(tf2_ros.WHOSE, tf_transformations.__name__)"],
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.stdout == "theirs gz_course.sim.ros.tf_transformations\n", done.stderr
