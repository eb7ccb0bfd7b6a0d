"""glTF 2.0: from a take to nodes, a skin that makes them a skeleton, and an animation."""

from __future__ import annotations

import base64
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.options import WriteOptions
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.take import Take

if TYPE_CHECKING:
    from pygltflib import GLTF2

Array = NDArray[np.float64]

# Words of the format.
_FLOAT = 5126
_TYPES = {(): "SCALAR", (3,): "VEC3", (4,): "VEC4", (4, 4): "MAT4"}


def looks_like_gltf(head: bytes) -> bool:
    """Tell glTF by its first bytes."""
    return head.startswith(b"glTF") or (head.lstrip().startswith(b"{") and b'"asset"' in head)


def write_gltf(
    *, binary: bool
) -> Callable[[Take, Sequence[Declared], WriteOptions], Iterator[bytes]]:
    """Return the writer of ``.glb`` (binary), or of ``.gltf`` with its buffer inside."""

    def write(take: Take, declared: Sequence[Declared], options: WriteOptions) -> Iterator[bytes]:
        """Bytes of the take as glTF 2.0; always in metres and Y up, as the format wants it.

        One node a joint under its own name, in the rest pose; a tip is a node named after the
        joint that carries it, with ``_end``. Rotations of all joints and translations of those
        that have them are channels of one animation that begins at time 0.

        Raises
        ------
        ParameterError
            If another unit, up axis, Euler order or number of channels is asked for.
        """
        _check(options)
        gltf, blob = _document(take, options)
        if binary:
            gltf.set_binary_blob(blob)
            yield from gltf.save_to_bytes()
        else:
            coded = base64.b64encode(blob).decode("ascii")
            gltf.buffers[0].uri = f"data:application/octet-stream;base64,{coded}"
            yield gltf.gltf_to_json().encode()

    return write


def _check(options: WriteOptions) -> None:
    if options.unit not in (None, 1.0) or options.up not in (None, "y"):
        raise ParameterError("glTF is always in metres and Y up")
    if options.order is not None or options.channels is not None:
        raise ParameterError("glTF holds quaternions: it has no Euler order and no channels")


class _Buffer:
    """Arrays one after the other, each with its accessor."""

    def __init__(self, gltf: GLTF2) -> None:
        self.gltf, self.pieces, self.size = gltf, list[bytes](), 0

    def add(self, values: Array, *, bounds: bool = False) -> int:
        """Append an array whose first axis counts elements; return its accessor's index."""
        from pygltflib import Accessor, BufferView

        floats = np.ascontiguousarray(values, dtype="<f4")
        raw = floats.tobytes()
        self.gltf.bufferViews.append(
            BufferView(buffer=0, byteOffset=self.size, byteLength=len(raw))
        )
        self.pieces.append(raw)
        self.size += len(raw)
        accessor = Accessor(
            bufferView=len(self.gltf.bufferViews) - 1,
            componentType=_FLOAT,
            count=len(floats),
            type=_TYPES[floats.shape[1:]],
        )
        if bounds:
            accessor.min, accessor.max = [float(floats.min())], [float(floats.max())]
        self.gltf.accessors.append(accessor)
        return len(self.gltf.accessors) - 1


def _document(take: Take, options: WriteOptions) -> tuple[GLTF2, bytes]:
    import pygltflib

    gltf = pygltflib.GLTF2(
        asset=pygltflib.Asset(version="2.0", generator="mocapstudio"),
        scene=0,
        scenes=[pygltflib.Scene(name=take.name, nodes=[0])],
        nodes=_nodes(take),
        extras={"fps": float(take.rate)},
    )
    buffer = _Buffer(gltf)
    gltf.skins = [
        pygltflib.Skin(
            name=take.name,
            joints=list(range(len(gltf.nodes))),
            skeleton=0,
            inverseBindMatrices=buffer.add(_inverse_bind(take)),
        )
    ]
    gltf.animations = [_animation(take, options, buffer)]
    gltf.buffers = [pygltflib.Buffer(byteLength=buffer.size)]
    return gltf, b"".join(buffer.pieces)


def _nodes(take: Take) -> list[object]:
    from pygltflib import Node

    skeleton = take.skeleton
    nodes = [
        Node(name=name, translation=(offset + 0.0).tolist(), children=list(below))
        for name, offset, below in zip(
            skeleton.names, skeleton.offsets, skeleton.children, strict=True
        )
    ]
    taken = set(skeleton.names)
    for parent, offset in zip(skeleton.end_parents, skeleton.end_offsets, strict=True):
        name = f"{skeleton.names[parent]}_end"
        while name in taken:
            name += "_end"
        taken.add(name)
        nodes[parent].children.append(len(nodes))
        nodes.append(Node(name=name, translation=(offset + 0.0).tolist(), children=[]))
    return nodes


def _inverse_bind(take: Take) -> Array:
    """(N, 4, 4) from the world to each node in the rest pose, columns first as glTF has them."""
    skeleton = take.skeleton
    ends = skeleton.rest_positions[skeleton.end_parents] + skeleton.end_offsets
    places = np.concatenate([skeleton.rest_positions, ends])
    matrices = np.tile(np.eye(4), (len(places), 1, 1))
    matrices[:, 3, :3] = -places
    return matrices


def _animation(take: Take, options: WriteOptions, buffer: _Buffer) -> object:
    from pygltflib import Animation, AnimationChannel, AnimationChannelTarget, AnimationSampler

    start, end = take.span if options.trim else (0, take.frames)
    times = buffer.add(np.arange(end - start) / float(take.rate), bounds=True)
    tracks = [(j, "rotation", take.rotations[start:end, j]) for j in range(len(take.skeleton))]
    tracks += [
        (j, "translation", take.translations[start:end, t]) for t, j in enumerate(take.translated)
    ]
    animation = Animation(name=take.name, channels=[], samplers=[])
    for joint, path, values in tracks:
        sampler = AnimationSampler(input=times, output=buffer.add(values), interpolation="LINEAR")
        animation.samplers.append(sampler)
        target = AnimationChannelTarget(node=joint, path=path)
        animation.channels.append(
            AnimationChannel(sampler=len(animation.samplers) - 1, target=target)
        )
    return animation
