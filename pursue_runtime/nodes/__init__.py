"""The rospy nodes: topics, parameters and threads; what they do is decided in the other folders."""
