"""gz.transport under the name it has in Gazebo Harmonic, so that code written for Harmonic runs unchanged.

Where the real gz.transport13 is installed, it is what is imported.
"""

from gz_course.sim.gz.msgs.real_installation import give_way

if not give_way(__name__, __file__):
    from gz_course.sim.gz.transport import *  # noqa: F403
    from gz_course.sim.gz.transport import __all__ as __all__
