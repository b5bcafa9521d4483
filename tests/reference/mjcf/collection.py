#!/usr/bin/env python3
"""Files of a collection against MuJoCo: `collection.py MBINT ROOT [FILE ...]`, with PyPI's `mujoco` 4.0; all XML below ROOT without FILE.

Of every file that MuJoCo loads and in which something moves: whether `mbint check` reads it, else why not; and, where it has no
equalities, the largest difference of the joints' accelerations at the start over the largest of them. Contacts, limits and dry
friction, which is soft in MuJoCo, are off.
"""

import collections
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

import mujoco

mbint, root = sys.argv[1], pathlib.Path(sys.argv[2])
files = [pathlib.Path(name) for name in sys.argv[3:]] or sorted(root.rglob("*.xml"))
OFF = mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_LIMIT | mujoco.mjtDisableBit.mjDSBL_FRICTIONLOSS
HINGE, SLIDE = int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE)


def run(*arguments):
    command = [mbint, arguments[0], "--root", str(root), *map(str, arguments[1:])]
    return subprocess.run(command, capture_output=True, text=True, timeout=600)


def in_formulas(name):
    name = "".join(c if c.isalnum() else "_" for c in name)
    return f"_{name}" if name[0].isdigit() else name


def differences(model, file):
    """Relative, of the joints that have a name and one coordinate."""
    model.opt.disableflags |= OFF
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    joints = [model.joint(index) for index in range(model.njnt)]
    joints = [joint for joint in joints if joint.name and joint.type[0] in (HINGE, SLIDE)]
    if not joints:
        return None
    member = {HINGE: "angular_acceleration", SLIDE: "acceleration"}
    names = [in_formulas(joint.name) for joint in joints]
    outputs = [f"o{i}: {name}.{member[joint.type[0]]}" for i, (name, joint) in enumerate(zip(names, joints))]
    without = [f"{name}_friction" for name, joint in zip(names, joints) if model.dof_frictionloss[joint.dofadr[0]] > 0]
    with tempfile.NamedTemporaryFile("w", suffix=".yaml", dir=file.parent) as text, tempfile.TemporaryDirectory() as folder:
        text.write(f"mjcf: {file.name}\noutputs: {{ {', '.join(outputs)} }}\nwithout: [{', '.join(without)}]\n")
        text.write("simulation: { duration: 1e-4, step: 1e-4, output_step: 1e-4 }\n")
        text.flush()
        result = run("run", text.name, "-o", folder)
        bounds = pathlib.Path(folder, "bounds.csv")
        if not bounds.exists():
            return result.stderr.strip()[-200:]
        row = next(csv.DictReader(bounds.open()))
    exact = [data.qacc[joint.dofadr[0]] for joint in joints]
    apart = max(abs(float(row[f"o{i}.nominal"]) - value) for i, value in enumerate(exact))
    return apart / max(1e-9, *map(abs, exact))


reasons, read, moving = collections.Counter(), 0, 0
for file in files:
    try:
        model = mujoco.MjModel.from_xml_path(str(file))
    except ValueError:
        continue
    if model.nv == 0:
        continue
    moving += 1
    result = run("check", file)
    if result.returncode:
        errors = set(re.findall(r"^error: (.*)", result.stderr, re.M))
        reasons.update(errors)
        print(f"{file}: {'; '.join(sorted(errors))}")
        continue
    read += 1
    print(f"{file}: {'has equalities' if model.neq else differences(model, file)}", flush=True)
print(f"{read} of {moving} are read")
for reason, count in reasons.most_common():
    print(f"{count} {reason}")
