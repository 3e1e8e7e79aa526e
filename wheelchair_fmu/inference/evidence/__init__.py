"""What a campaign says about a model at given values: innovations, sensitivities, noise, and forces that nobody recorded."""
