"""The book: all chapters with the outputs of a fresh run, as pages that need no network. `make book` writes it."""
