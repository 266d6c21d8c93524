"""What runs on robots: the run time of missions, the same in every workspace.

Plain Python; nothing but `nodes` needs ROS.
"""

__version__ = "0.2.0"
