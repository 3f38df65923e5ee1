"""`python -m gz_course.sim.view`."""

import sys

from gz_course.sim.view.program import main

sys.exit(main())
