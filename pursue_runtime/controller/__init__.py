"""What a controller decides: its next command, and what its robots are told."""
