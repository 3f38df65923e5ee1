"""Mistakes with time: clocks, units, parts of stamps, sums and starts."""
