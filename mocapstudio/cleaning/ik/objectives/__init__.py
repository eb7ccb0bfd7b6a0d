"""Objectives: small objects that give residual and analytic Jacobian."""
