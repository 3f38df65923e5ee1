"""What systems and sensors are built on: their base classes, how a plugin is found, what it may use of its world."""
