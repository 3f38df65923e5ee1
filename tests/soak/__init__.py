"""Long runs: a world with its bridge and nodes, and a class, watched for growth. `make soak` runs them."""
