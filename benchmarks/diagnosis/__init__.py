"""The loop held against hidden truths of a simulator that shares nothing with the model: `make bench-diagnosis`."""
