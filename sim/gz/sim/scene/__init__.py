"""What there is in a world, for those who look at it from outside: the scene graph, gz.msgs.Scene, serialized state."""
