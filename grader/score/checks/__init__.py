"""The kinds of checks that a manifest can name, one file each; every module in this folder is a kind."""
