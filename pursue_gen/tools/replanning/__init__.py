"""A new plan for a mission that is under way, from where it is now."""

from pursue_gen.tools.replanning.replan import replan

__all__ = ["replan"]
