"""From the model to an FMU: describe, generate, compile, pack, validate."""
