"""The archives in other people's importers."""
