"""Why an objective cannot be met: what would change that, and a play that shows it."""
