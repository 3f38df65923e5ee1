"""Sub-commands of `gz` about message types."""
