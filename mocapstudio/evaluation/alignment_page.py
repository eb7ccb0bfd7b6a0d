"""The pictures of online alignment: quality over the share of the movement seen."""

from __future__ import annotations

import html
import math
from collections.abc import Mapping, Sequence

from mocapstudio.comparison.online_features import F64

# Okabe and Ito's colours, distinct to the colour-blind; a method keeps its own in all figures.
_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c8c8c", "#117733")
_WIDTH, _HEIGHT, _LEFT, _TOP, _BOTTOM, _RIGHT = 390, 340, 52, 30, 54, 24
_LINE = 15
_STEPS = (0.01, 0.02, 0.05, 0.1, 0.2)


def share_curves(
    title: str, shares: Sequence[float], curves: Mapping[str, F64], methods: Sequence[str]
) -> str:
    """Draw quality (0..1) over the share of the movement seen, a line a method.

    Parameters
    ----------
    shares
        K, in 0..1.
    curves
        (K,) values of each line.
    methods
        All methods in their order, which tells a line's colour.
    """
    panel = _Panel(min(float(curve.min()) for curve in curves.values()), len(curves))
    parts = [f'<text class="name" x="{_LEFT}" y="14">{html.escape(title)}</text>', *panel.grid()]
    for i, (name, curve) in enumerate(curves.items()):
        colour = _COLOURS[methods.index(name) % len(_COLOURS)]
        points = " ".join(
            f"{panel.x(share):.1f},{panel.y(float(value)):.1f}"
            for share, value in zip(shares, curve, strict=True)
        )
        line = _HEIGHT - 6 - _LINE * (len(curves) - 1 - i)
        parts.append(
            f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>'
            f'<path d="M{_LEFT},{line - 4}h18" stroke="{colour}" stroke-width="3"/>'
            f'<text x="{_LEFT + 24}" y="{line}">{html.escape(name)}, mean'
            f" {100 * float(curve.mean()):.1f}</text>"
        )
    return (
        f'<figure><svg viewBox="0 0 {_WIDTH} {_HEIGHT}" width="{_WIDTH}" height="{_HEIGHT}">'
        f"{''.join(parts)}</svg></figure>"
    )


class _Panel:
    """Where shares and qualities lie, from just below the lowest quality up to 1."""

    def __init__(self, lowest: float, curves: int) -> None:
        # Lines at whole percents, between three and six of them.
        self._step = next(size for size in _STEPS if 1 - lowest <= 6 * size)
        self._count = max(3, math.ceil((1 - lowest) / self._step - 1e-9))
        self._low = 1 - self._count * self._step
        self._wide = _WIDTH - _LEFT - _RIGHT
        self._high = _HEIGHT - _TOP - _BOTTOM - _LINE * curves

    def x(self, share: float) -> float:
        return _LEFT + share * self._wide

    def y(self, quality: float) -> float:
        return _TOP + (1 - (quality - self._low) / (1 - self._low)) * self._high

    def grid(self) -> list[str]:
        parts = []
        for i in range(self._count + 1):
            quality = self._low + i * self._step
            parts.append(
                f'<path class="axis" fill="none" d="M{_LEFT},{self.y(quality):.1f}h{self._wide}"/>'
                f'<text x="{_LEFT - 6}" y="{self.y(quality) + 4:.1f}" text-anchor="end">'
                f"{100 * quality:.0f}</text>"
            )
        parts += [
            f'<path class="axis" fill="none" d="M{self.x(share):.1f},{_TOP}v{self._high}"/>'
            f'<text x="{self.x(share):.1f}" y="{_TOP + self._high + 15}" text-anchor="middle">'
            f"{100 * share:.0f} %</text>"
            for share in (0.2, 0.4, 0.6, 0.8, 1.0)
        ]
        middle = _TOP + self._high / 2
        return [
            *parts,
            f'<text x="{self.x(0.5):.1f}" y="{_TOP + self._high + 31:.1f}" text-anchor="middle">'
            "share of the movement seen</text>",
            f'<text x="12" y="{middle:.1f}" text-anchor="middle"'
            f' transform="rotate(-90 12 {middle:.1f})">quality in %</text>',
        ]
