"""Is this machine so busy that a program which has not answered may just not have had its turn?"""

from __future__ import annotations

import os

CROWDED = 2.0  # processes that want to compute for each processor, by the load average of a minute


def crowded() -> bool:
    return os.getloadavg()[0] > CROWDED * (os.cpu_count() or 1)
