"""The recorder: a node that hears topics, and a thread that writes what it has heard."""
