"""What Blender does for mocapstudio, run by Blender itself and without a window.

    blender --background --factory-startup --python exchange.py -- read IN.fbx OUT.npz
    blender --background --factory-startup --python exchange.py -- write IN.bvh OUT.fbx FPS FPS_BASE

Reading takes the world matrices of all bones of every armature, at rest and in every frame, so
that no convention of another format stands between. Places are in metres, Z up.
"""

import sys
from pathlib import Path

import bpy
import numpy as np


def read(source, target):
    """Keep what moves in an FBX as arrays."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with Path(source).open("rb") as file:
        binary = file.read(18) == b"Kaydara FBX Binary"
    # The newer importer reads FBX kept as text, but takes no notice of rates that are not usual.
    if binary and hasattr(bpy.ops.import_scene, "fbx"):
        bpy.ops.import_scene.fbx(filepath=source)
        # It places keys by the whole frames a second: at 119.88 a file's frame is 1.001 of them.
        step = bpy.context.scene.render.fps_base
    else:
        bpy.ops.wm.fbx_import(filepath=source, use_anim=True)
        step = 1.0
    scene = bpy.context.scene
    found = {
        "blender": np.array(bpy.app.version_string),
        "fps": np.array([scene.render.fps, scene.render.fps_base]),
        "actions": np.array(len(bpy.data.actions)),
    }
    armatures = [one for one in bpy.data.objects if one.type == "ARMATURE" and one.data.bones]
    for number, armature in enumerate(armatures):
        for key, values in motion(scene, armature, step).items():
            found[f"{number}/{key}"] = values
    np.savez(target, **found)


def motion(scene, armature, step):
    """Names, parents, rest matrices and world matrices of an armature's bones."""
    bones = list(armature.data.bones)
    index = {bone.name: number for number, bone in enumerate(bones)}
    action = armature.animation_data.action if armature.animation_data else None
    first, last = action.frame_range if action else (1.0, 1.0)
    frames = round((last - first) / step) + 1
    world = np.empty((frames, len(bones), 4, 4), dtype=np.float32)
    poses = [armature.pose.bones[bone.name] for bone in bones]
    for row in range(frames):
        at = first + row * step
        whole = int(at // 1)
        scene.frame_set(whole, subframe=at - whole)
        placed = armature.matrix_world
        for column, pose in enumerate(poses):
            world[row, column] = placed @ pose.matrix
    return {
        "name": np.array(armature.name),
        "names": np.array([bone.name for bone in bones]),
        "parents": np.array([index[b.parent.name] if b.parent else -1 for b in bones]),
        "rest": np.array([armature.matrix_world @ bone.matrix_local for bone in bones]),
        "world": world,
    }


def write(source, target, fps, fps_base):
    """Write the skeleton and motion of a BVH in metres, Y up, as FBX, every frame as it is."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_anim.bvh(filepath=source, frame_start=1)
    # The frames of the BVH are the frames of the scene, whatever its rate.
    scene = bpy.context.scene
    scene.render.fps, scene.render.fps_base = int(fps), float(fps_base)
    armature = bpy.context.object
    scene.frame_start = 1
    scene.frame_end = round(armature.animation_data.action.frame_range[1])
    # FBX keeps as rest pose the one at which the file is written.
    for bone in armature.pose.bones:
        bone.location = (0, 0, 0)
        bone.rotation_euler = (0, 0, 0)
        bone.keyframe_insert("location", frame=0)
        bone.keyframe_insert("rotation_euler", frame=0)
    scene.frame_set(0)
    bpy.ops.export_scene.fbx(
        filepath=target,
        object_types={"ARMATURE"},
        add_leaf_bones=True,
        bake_anim=True,
        bake_anim_use_nla_strips=False,
        bake_anim_use_all_actions=False,
        bake_anim_simplify_factor=0.0,
    )


if __name__ == "__main__":
    job, *arguments = sys.argv[sys.argv.index("--") + 1 :]
    {"read": read, "write": write}[job](*arguments)
