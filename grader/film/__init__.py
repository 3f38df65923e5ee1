"""Pictures and films of recorded runs, without a display or a GPU.

`stage.py` builds the recorded world again and looks at it with the simulator's ray-cast camera, `picture.py` adds the
scan, the path and the verdicts, `film.py` writes files.
"""
