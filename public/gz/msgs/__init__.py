"""`gz.msgs` without a version number: the package of the course."""

from gz_course.sim.public_name import stand_for

stand_for(__name__, "gz_course.sim.gz.msgs")
