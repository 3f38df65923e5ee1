"""What systems that drive joints and wheels are built on: controllers, speed limits, odometry."""
