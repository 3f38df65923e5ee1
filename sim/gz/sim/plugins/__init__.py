"""Base classes of systems and sensors, the lookup of plugins, and the interface of the world that they use."""
