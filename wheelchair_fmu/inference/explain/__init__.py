"""A diagnosis told and drawn: the ranking, the story, likelihoods about the estimates."""
