"""The independent checker of strategies, and what follows from its closed loop: smaller ones, margin, worst case."""
