"""What the observer decides: the state of the mission, its journal, new plans."""
