"""The verdict and what follows from it: the next experiment, a better model, the final estimates."""
