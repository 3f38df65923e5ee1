"""The player: a node that publishes what a bag holds, when its clock says so."""
