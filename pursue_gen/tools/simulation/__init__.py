"""The generated decision code in closed loop with a simulated world, without ROS: thousands of missions a minute."""
