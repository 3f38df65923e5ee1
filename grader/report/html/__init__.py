"""The report as one HTML page that needs nothing else: no network, no scripts; for paper and screen readers too."""
