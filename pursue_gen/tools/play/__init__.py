"""A scenario as a game for one person: the others against the strategy, or the robots against a counter-strategy."""
