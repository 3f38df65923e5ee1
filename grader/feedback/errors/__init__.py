"""What errors mean whose own text does not say what to change: of Python and rclpy, launch files, bridges, goals."""
