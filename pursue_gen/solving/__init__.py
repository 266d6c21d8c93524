"""From a request to a proven solution: rules of the game, engines, plans from elsewhere, least time."""
