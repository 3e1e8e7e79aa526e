"""Effects to begin with: `wheelchair effects new` copies one of these files, under another id."""
