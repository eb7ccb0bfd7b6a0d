"""Small BVH files for the tests of the reader and the writer."""

from __future__ import annotations

import numpy as np

HEADER = """HIERARCHY
ROOT Hips
{
\tOFFSET 0.0 0.0 0.0
\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
\tJOINT LeftUpLeg
\t{
\t\tOFFSET 10.0 -5.0 0.0
\t\tCHANNELS 3 Zrotation Xrotation Yrotation
\t\tJOINT LeftLeg
\t\t{
\t\t\tOFFSET 0.0 -42.0 0.0
\t\t\tCHANNELS 3 Xrotation Yrotation Zrotation
\t\t\tJOINT LeftFoot
\t\t\t{
\t\t\t\tOFFSET 0.0 -40.0 0.0
\t\t\t\tCHANNELS 3 Zrotation Yrotation Xrotation
\t\t\t\tEnd Site
\t\t\t\t{
\t\t\t\t\tOFFSET 0.0 0.0 15.0
\t\t\t\t}
\t\t\t}
\t\t}
\t}
\tJOINT RightUpLeg
\t{
\t\tOFFSET -10.0 -5.0 0.0
\t\tCHANNELS 3 Yrotation Zrotation Xrotation
\t\tJOINT RightLeg
\t\t{
\t\t\tOFFSET 0.0 -42.0 0.0
\t\t\tCHANNELS 3 Yrotation Xrotation Zrotation
\t\t\tJOINT RightFoot
\t\t\t{
\t\t\t\tOFFSET 0.0 -40.0 0.0
\t\t\t\tCHANNELS 3 Xrotation Zrotation Yrotation
\t\t\t\tEnd Site
\t\t\t\t{
\t\t\t\t\tOFFSET 0.0 0.0 15.0
\t\t\t\t}
\t\t\t}
\t\t}
\t}
\tJOINT Spine
\t{
\t\tOFFSET 0.0 20.0 0.0
\t\tCHANNELS 3 Zrotation Xrotation Yrotation
\t\tJOINT Head
\t\t{
\t\t\tOFFSET 0.0 40.0 0.0
\t\t\tCHANNELS 3 Zrotation Xrotation Yrotation
\t\t\tEnd Site
\t\t\t{
\t\t\t\tOFFSET 0.0 20.0 0.0
\t\t\t}
\t\t}
\t}
}
"""
COLUMNS = 3 + 9 * 3
JOINTS = (
    *("Hips", "LeftUpLeg", "LeftLeg", "LeftFoot", "RightUpLeg", "RightLeg", "RightFoot"),
    *("Spine", "Head"),
)
HEADER_LINES = HEADER.count("\n")
"""MOTION stands on the line after these, the first row three lines further on."""


def walk(frames: int = 30, seed: int = 0, columns: int = COLUMNS) -> np.ndarray:
    """(frames, columns) smooth rows: a place in centimetres, angles in degrees."""
    generator = np.random.default_rng(seed)
    time = np.arange(frames)[:, None] / 30.0
    phase = generator.uniform(0, 2 * np.pi, columns)
    size = generator.uniform(5, 60, columns)
    rows = size * np.sin(2 * np.pi * 0.7 * time + phase)
    rows[:, 1] += 95
    rows[:, 2] += 60 * time[:, 0]
    return rows


def bvh(rows: np.ndarray, header: str = HEADER, frame_time: str = "0.0333333") -> str:
    """Text of a file with these rows."""
    body = "".join(" ".join(f"{cell:.6f}" for cell in row) + "\n" for row in rows)
    return f"{header}MOTION\nFrames: {len(rows)}\nFrame Time: {frame_time}\n{body}"
