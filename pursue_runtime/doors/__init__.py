"""Doors that open by themselves: when each is asked to open and to close, and for whom it is open."""
