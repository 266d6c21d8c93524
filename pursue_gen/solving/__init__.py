"""From what a person asks for to a proven solution: rules of the game, engines, plans from elsewhere, least time."""
