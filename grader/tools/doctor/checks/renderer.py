"""Which renderers can cameras use here? Ray casting always works; OpenGL is optional."""

from __future__ import annotations

from gz_course.grader.tools.doctor.probe import ProbeError, Probes
from gz_course.grader.tools.doctor.verdict import Verdict, fine, warning

TITLE = "renderer of cameras"
_CODE = "from gz_course.sim.gz.sim.rendering.renderer import gl_backend; print(gl_backend() or '')"
_FIX = (
    "nothing to do for the exercises; for `--render-engine mujoco` install EGL (Debian: libegl1 libgl1-mesa-dri) "
    "or OSMesa (libosmesa6)"
)


def examine(probes: Probes) -> Verdict:
    """Ask the simulator whether MuJoCo can render."""
    try:
        backend = probes.run(_CODE)
    except ProbeError as error:
        return warning(f"raycast; whether OpenGL works could not be found out: {error}", _FIX)
    if not backend:
        return warning("raycast only; OpenGL without a screen does not work here", _FIX)
    return fine(f"raycast (the default), and mujoco by OpenGL ({backend})")
