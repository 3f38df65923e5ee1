"""Sub-commands of `gz` about topics and services, and what they share."""
