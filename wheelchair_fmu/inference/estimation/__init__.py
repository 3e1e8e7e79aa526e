"""Best values, their standard errors and intervals, score tests and marginal likelihoods, from evidence."""
