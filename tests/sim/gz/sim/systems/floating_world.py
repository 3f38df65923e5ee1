"""A model of one link with one shape, for the systems of fluids and air."""

from __future__ import annotations


def body(
    shape: str = "<sphere><radius>0.5</radius></sphere>",
    *,
    mass: float = 10.0,
    pose: str = "0 0 0 0 0 0",
    before: str = "",
    plugins: str = "",
    at: str = "0 0 0 0 0 0",
    name: str = "a",
) -> str:
    """Return a model `name` with the link `l`; its collision is placed `at` in the link."""
    inertia = "".join(f"<{axis}>{mass / 10.0}</{axis}>" for axis in ("ixx", "iyy", "izz"))
    return f"""<model name='{name}'><pose>{pose}</pose>{before}<link name='l'><inertial><mass>{mass}</mass>
      <inertia>{inertia}</inertia></inertial>
      <collision name='c'><pose>{at}</pose><geometry>{shape}</geometry></collision></link>{plugins}</model>"""
