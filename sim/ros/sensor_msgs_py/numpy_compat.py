"""Conversions between structured and plain arrays, which every NumPy of today brings itself."""

from numpy.lib.recfunctions import structured_to_unstructured, unstructured_to_structured

__all__ = ["structured_to_unstructured", "unstructured_to_structured"]
