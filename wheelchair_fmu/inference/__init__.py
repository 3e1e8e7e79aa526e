"""Where the model fails, which effect is missing, and what to measure next. Not one word of physics here."""
