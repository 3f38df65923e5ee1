"""Mistakes with rclpy and tf2: callbacks, spinning, waiting, publishers, parameters, actions, transforms."""
