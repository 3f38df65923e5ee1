"""Sub-commands of `gz` about simulations: `gz sim`, `gz model`, `gz log`, ... One file each, found by `gz.command`."""
