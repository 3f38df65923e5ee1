"""Gazebo: messages (`msgs`), topics and services (`transport`), the simulator (`sim`), and the `gz` command."""
