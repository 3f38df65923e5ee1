"""Benchmarks, run by `make bench`: ratios against a reference of the same run."""
