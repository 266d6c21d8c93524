"""Design time → robots (thesis: Rest2Ros): missions as signed bundles of data, and what sends them."""
