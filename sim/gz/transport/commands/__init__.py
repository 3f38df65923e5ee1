"""Sub-commands of `gz` about topics and services."""
