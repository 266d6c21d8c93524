"""What people have already, as a scenario: the building file of Open-RMF's traffic editor, lists of places."""
