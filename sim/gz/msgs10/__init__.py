"""gz.msgs under the name it has in Gazebo Harmonic: `from gz.msgs10.twist_pb2 import Twist` is the same class.

Where the real gz.msgs10 is installed, it is what is imported.
"""

from gz_course.sim.gz.msgs.real_installation import give_way

if not give_way(__name__, __file__):
    from gz_course.sim.gz.msgs import *  # noqa: F403
    from gz_course.sim.gz.msgs import __all__ as __all__
