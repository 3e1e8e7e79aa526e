"""From data to figures, and figures to files."""
