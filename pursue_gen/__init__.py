"""PuRSUE-gen: from a scenario in PuRSUE-ML to a ROS 1 workspace with one proven controller per robot."""

__version__ = "0.1.0"
