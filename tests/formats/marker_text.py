"""Small TRC files for the tests of readers and writers of markers."""

from __future__ import annotations

import numpy as np

LABELS = ("LFHD", "C7", "LKNE", "LTOE")


def places(frames: int = 12, markers: int = len(LABELS), seed: int = 0) -> np.ndarray:
    """(frames, markers, 3) millimetres, Y up, the head above the feet."""
    generator = np.random.default_rng(seed)
    heights = np.linspace(1600, 50, markers)
    still = generator.uniform(-200, 200, (markers, 3))
    still[:, 1] = heights
    sway = generator.uniform(5, 40, (markers, 3))
    time = np.arange(frames)[:, None, None] / 50
    return still + sway * np.sin(2 * np.pi * time + sway)


def cell(value: float, decimals: int = 3) -> str:
    return "" if np.isnan(value) else f"{value:.{decimals}f}"


def trc_lines(positions: np.ndarray, labels=LABELS, rate: float = 100.0) -> list[str]:
    """Lines of a TRC as Cortex writes it; line 7 is the first row."""
    frames, markers = positions.shape[:2]
    keys = "DataRate CameraRate NumFrames NumMarkers Units OrigDataRate OrigDataStartFrame"
    return [
        "PathFileType\t4\t(X/Y/Z)\ttake.trc",
        f"{keys} OrigNumFrames".replace(" ", "\t"),
        f"{rate:.2f}\t{rate:.2f}\t{frames}\t{markers}\tmm\t{rate:.2f}\t1\t{frames}",
        "Frame#\tTime\t" + "".join(f"{label}\t\t\t" for label in labels),
        "\t\t" + "\t".join(f"{axis}{i}" for i in range(1, markers + 1) for axis in "XYZ"),
        "",
        *(
            "\t".join([str(i), f"{(i - 1) / rate:.3f}", *map(cell, row.ravel())])
            for i, row in enumerate(positions, 1)
        ),
    ]


def trc(positions: np.ndarray, labels=LABELS, rate: float = 100.0) -> str:
    """Text of a TRC."""
    return "\n".join(trc_lines(positions, labels, rate)) + "\n"
