"""Screen, refit, hold out, compare rivals: which effects a chair has."""
