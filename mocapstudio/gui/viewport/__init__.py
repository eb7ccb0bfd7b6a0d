"""What the 3-D view is made of: poses, meshes, camera, picking, overlays."""
