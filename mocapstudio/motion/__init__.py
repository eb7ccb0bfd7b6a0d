"""What a motion is: skeleton, take, rotations, kinematics."""
