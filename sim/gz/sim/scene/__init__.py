"""The contents of a world as messages: scene graph, gz.msgs.Scene and serialized state."""
