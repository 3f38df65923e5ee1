"""The systems that no chapter, exercise, built-in world or built-in model names; found like all others."""
