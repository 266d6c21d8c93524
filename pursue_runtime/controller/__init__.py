"""The decisions of a controller: its next command, and goals and actions for its robots."""
