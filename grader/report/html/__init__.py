"""The report as one self-contained HTML page without network access, also for paper and screen readers.

Its only script plays the run; without scripts the run is a picture.
"""
