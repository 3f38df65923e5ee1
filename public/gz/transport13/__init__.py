"""`gz.transport13`, the name in Gazebo Harmonic; an installed package of this name is imported instead."""

from gz_course.sim.public_name import give_way, stand_for

if not give_way(__name__, __file__):
    stand_for(__name__, "gz_course.sim.gz.transport")
