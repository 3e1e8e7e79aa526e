"""The `wheelchair` command: one file per command group."""
