"""The kinds of checks a manifest can name: one file each, found by being in this folder."""
