"""What to say of a scan."""

from .mean import mean


def summary(valid):
    return f"Scan: {len(valid)} valid rays, min={min(valid):.2f}m, avg={mean(valid):.2f}m"
