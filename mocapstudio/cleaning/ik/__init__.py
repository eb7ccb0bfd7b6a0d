"""Inverse kinematics over the whole body and over time: objectives, limits, solve, clean-up."""
