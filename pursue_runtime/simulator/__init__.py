"""When the movements and actions of simulated agents end, and simulated time."""
