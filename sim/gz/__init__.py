"""Gazebo: messages (`msgs`), topics and services (`transport`), simulator (`sim`), its view, and the `gz` command."""
