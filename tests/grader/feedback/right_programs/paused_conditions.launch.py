"""Starts gz sim without its launch file: two variants of one command, of which a condition picks one."""

import sys
from os.path import abspath, dirname, join

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.conditions import LaunchConfigurationEquals, LaunchConfigurationNotEquals
from launch.substitutions import LaunchConfiguration, ThisLaunchFileDir
from launch_ros.actions import Node

BESIDE_ME = dirname(abspath(__file__))


def gz_sim(*options, **kw):
    return ExecuteProcess(cmd=["gz", "sim", LaunchConfiguration("world"), "-s", *options], output="screen", **kw)


def run(package, program, *parameters):
    """As `ros2 run package program --ros-args -p ...`."""
    options = [word for parameter in parameters for word in ("-p", parameter)]
    return Node(package=package, executable=program, ros_arguments=options, output="screen")


def generate_launch_description():
    description = LaunchDescription()
    add = description.add_action
    add(DeclareLaunchArgument("world", default_value="lidar_room.sdf", description="World to be simulated"))
    add(DeclareLaunchArgument("paused", default_value="false", description="true or false"))
    add(gz_sim(condition=LaunchConfigurationEquals("paused", "true")))
    add(gz_sim("-r", condition=LaunchConfigurationNotEquals("paused", "true")))
    add(run("ros_gz_bridge", "parameter_bridge", "config_file:=" + join(BESIDE_ME, "bridge.yaml")))
    add(
        ExecuteProcess(
            cmd=[sys.executable, [ThisLaunchFileDir(), "/stopwatch.py"], "--ros-args", "-p", "use_sim_time:=true"],
        )
    )
    return description
