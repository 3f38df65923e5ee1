"""`nav2_common` of Navigation2, for machines without it; an installed one comes first on the import path."""

import launch

from gz_course.sim.public_name import stand_beside

stand_beside(launch, __name__, "gz_course.sim.ros.nav2_common")
