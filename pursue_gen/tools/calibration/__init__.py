"""Times that were measured (missions, drives) → windows for the model, what they change, and a scenario with them."""
