"""Sub-commands of `gz` that look at simulations: `gz model`, `gz log`. One file each, found by `gz.command`."""
