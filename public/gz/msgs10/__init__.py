"""`gz.msgs10`, as Gazebo Harmonic calls it; where the real one is installed, that one is imported."""

from gz_course.sim.public_name import give_way, stand_for

if not give_way(__name__, __file__):
    stand_for(__name__, "gz_course.sim.gz.msgs")
