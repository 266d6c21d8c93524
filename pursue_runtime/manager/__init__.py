"""How a robot takes missions from the desk over HTTP."""
