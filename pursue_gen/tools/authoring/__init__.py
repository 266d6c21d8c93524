"""Beginning a scenario: a first one from a few answers, and the ones that come with the package."""
