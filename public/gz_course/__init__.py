"""The private namespace of the course: all of its code is imported by names that begin with `gz_course`.

A name is the path of its file: `gz_course.sim.gz.transport.node` is `sim/gz/transport/node.py`. In an installation
`sim/` and `grader/` are folders of this package; in a checkout they are two folders above it, and links in this folder
lead there, for the tools that follow imports by the text alone. Python itself takes the folders, so that `__file__` is
the path of a file in the checkout. The students' copy of a checkout has what grades its exercises in a folder apart.
"""

import os
import sys

_here = os.path.dirname(os.path.abspath(__file__))  # noqa: PTH100, PTH120 - pathlib would slow every start of Python
_sim = os.path.join(_here, "sim")  # noqa: PTH118
if os.path.islink(_sim) or not os.path.isdir(_sim):  # noqa: PTH112, PTH114
    __path__ = [os.path.dirname(os.path.dirname(_here))]  # noqa: PTH120
    _grading = os.path.join(__path__[0], ".grading")  # noqa: PTH118
    if os.path.isdir(_grading):  # noqa: PTH112
        __path__.append(_grading)
    try:
        os.listdir(__path__[0])  # noqa: PTH208
    except PermissionError:  # in a sandbox the folder can be entered but not listed, so its packages are not found
        sim = type(sys)("gz_course.sim")
        sim.__path__ = [os.path.join(__path__[0], "sim")]  # noqa: PTH118
        sys.modules["gz_course.sim"] = sim
