"""What is done with scenarios, strategies and missions beside the pipeline.

A tool needs stages; no stage needs a tool.
"""
