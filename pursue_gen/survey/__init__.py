"""A scenario's places on a map of the building: lengths of ways, travel times, room for robots.

Needs numpy and scipy; `survey.make` is what commands call, and says so where they are missing.
"""
