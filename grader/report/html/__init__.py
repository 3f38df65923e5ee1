"""The report as one self-contained HTML page without network access or scripts, also for paper and screen readers."""
