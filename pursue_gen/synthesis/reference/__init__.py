"""The readable engine, in Python: the native one's twin."""
