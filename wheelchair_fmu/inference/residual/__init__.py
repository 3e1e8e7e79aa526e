"""What is left of a model: how much, in which run, channel and regime, and which force would make up for it."""
