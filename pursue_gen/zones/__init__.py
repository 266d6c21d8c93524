"""DBMs and federations of them: what the solver and the checker share, and all that they share."""
