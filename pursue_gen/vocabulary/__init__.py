"""Names in networks in words for people: for messages, explanations, reports, games and pages."""
