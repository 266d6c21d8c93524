"""From a network and an objective to a strategy, and the proof that it wins."""
