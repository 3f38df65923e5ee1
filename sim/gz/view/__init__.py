"""The view of a running world in a web browser, in a process beside the simulator, on MuJoCo Studio's web viewer.

`open_view` starts one. The process (`program.py`) knows the world by `world_link.py` only, serves its page through
`gate.py`, and shows `window.py` with the `panels`. The simulator does not know of it: `gz.sim.systems.view_broadcaster`
sends the picture's data to whoever listens.
"""

from gz_course.sim.gz.view.view_process import View, ViewError, open_view

__all__ = ["View", "ViewError", "open_view"]
