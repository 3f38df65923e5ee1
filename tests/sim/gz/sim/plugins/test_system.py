"""What is said of plugins that are not simulated."""

from __future__ import annotations

import pytest

from gz_course.sim.gz.sim.world import World


@pytest.mark.parametrize(
    ("attributes", "sentence"),
    [
        ("filename='libobstacle1.so' name='turtlebot3_gazebo::Obstacle1Plugin'", "is not one of Gazebo's own"),
        ("filename='libobstacle1.so' name='obstacle1'", "is not one of Gazebo's own"),
        ("filename='gz-sim-dif-drive-system' name='gz::sim::systems::DifDrive'", "did you mean 'DiffDrive'"),
        ("filename='libgz-sim-imo-system.so' name=''", "no system is called"),
        (
            "filename='gz-sim-breadcrumbs-system' name='gz::sim::systems::Breadcrumbs'",
            "exists in Gazebo but not in this",
        ),
        ("filename='libgazebo_ros_diff_drive.so' name='d'", "is of Gazebo Classic"),
    ],
)
def test_a_plugin_that_does_not_run_is_explained(attributes: str, sentence: str) -> None:
    text = f"<sdf version='1.10'><world name='w'><plugin {attributes}/></world></sdf>"
    warning = World.from_string(text).warnings[0]
    assert sentence in warning
    assert ("did you mean" in warning) == ("did you mean" in sentence)
