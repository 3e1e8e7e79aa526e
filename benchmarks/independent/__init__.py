"""A wheelchair simulator and campaign generator that share nothing with the product's model, to test its diagnosis."""
