"""The files of a bag: read, written, and described by `metadata.yaml`."""
