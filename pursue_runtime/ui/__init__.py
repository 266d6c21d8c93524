"""The user's side: the terminal, the page in a browser, and who plays the agents that nobody controls."""
