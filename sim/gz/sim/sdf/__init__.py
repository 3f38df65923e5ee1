"""Reading SDF: XML (`element`), known words (`vocabulary`), files (`resources`), frames, and the description
of a world.
"""
