"""Where the description of a world becomes a MuJoCo model: `recipe` holds the numbers, `builder` the
mapping.
"""
