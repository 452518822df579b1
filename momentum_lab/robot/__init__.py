"""Who the robot is: named models, their soles and limits, and everything computed from one state."""
