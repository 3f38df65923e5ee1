"""`python -m gz_course.sim.gz.view`."""

import sys

from gz_course.sim.gz.view.program import main

sys.exit(main())
