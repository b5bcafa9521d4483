//! The elements of MJCF, from <https://mujoco.readthedocs.io/en/stable/XMLreference.html> and the schema that MuJoCo 4.0 prints.

use super::format::Fate::{Ignored, Refused, Supported};
use super::format::Rule;

const SOFT: &str = "constraints are rigid, and stops are as `limits` says";
const LOOKS: &str = "it is appearance";
const CONTACT: &str = "contacts of geoms are ignored: an effect `contact` says which surfaces touch";
const SOLVER: &str = "mbint has its own integration, as `simulation` says";
const NO_FLUID: &str = "there is no fluid: the effect `drag` resists";
const NO_PLUGIN: &str = "what a plugin does is not in the file";
const DELAY: &str = "controls act at once";
const DYNAMICS: &str = "the actuator has a state of its own: `states` and an effect say it";
const TRANSMISSION: &str = "actuators act on a joint or a fixed tendon: an effect `force` acts at a point";

const fn rule(tag: &'static str, within: &'static str) -> Rule {
    Rule { tag, within, fate: Supported, supported: "", ignored: &[], refused: &[] }
}

const fn ignored(tag: &'static str, within: &'static str, why: &'static str) -> Rule {
    Rule { fate: Ignored(why), ..rule(tag, within) }
}

const fn refused(tag: &'static str, within: &'static str, why: &'static str) -> Rule {
    Rule { fate: Refused(why), ..rule(tag, within) }
}

pub const SECTIONS: &[Rule] = &[
    Rule { ignored: &[("model", "a model is called like its file")], ..rule("mujoco", "") },
    Rule {
        supported: "file",
        ..rule("include", "mujoco worldbody body frame default asset actuator tendon equality contact sensor")
    },
    Rule {
        supported: "angle autolimits balanceinertia boundinertia boundmass coordinate eulerseq inertiafromgeom \
                    inertiagrouprange settotalmass",
        ignored: &[
            ("assetdir meshdir texturedir strippath", "no meshes are read"),
            (
                "alignfree fusestatic discardvisual usethread convexhull saveinertial savecanonical savecompiled conflict \
              passthrough",
                "it does not change the motion",
            ),
        ],
        refused: &[("fitaabb", "false", "it fits geoms to meshes, which are not read")],
        ..rule("compiler", "mujoco")
    },
    ignored("lengthrange", "compiler", "it is of muscles"),
    Rule {
        supported: "gravity",
        ignored: &[
            (
                "timestep integrator solver iterations tolerance ls_iterations ls_tolerance noslip_iterations \
              noslip_tolerance jacobian sdf_iterations sdf_initpoints sleep_tolerance",
                SOLVER,
            ),
            (
                "cone impratio ccd_iterations ccd_tolerance mpr_iterations mpr_tolerance o_margin o_friction apirate",
                CONTACT,
            ),
            ("o_solref o_solimp", SOFT),
            ("magnetic actuatorgroupdisable collision", "nothing of the motion depends on it"),
        ],
        refused: &[("density viscosity wind", "0", NO_FLUID)],
        ..rule("option", "mujoco")
    },
    Rule {
        supported: "gravity spring damper passive constraint equality frictionloss limit clampctrl actuation",
        ignored: &[
            ("contact filterparent refsafe midphase nativeccd multiccd diagexact island sleep override ipc", CONTACT),
            ("sensor energy fwdinv invdiscrete eulerdamp autoreset warmstart speculative", SOLVER),
        ],
        ..rule("flag", "option")
    },
    ignored("size", "mujoco", "it is memory"),
    ignored("statistic", "mujoco", LOOKS),
    ignored("visual", "mujoco", LOOKS),
    ignored("custom", "mujoco", "it is data of other programs"),
    refused("extension", "mujoco", NO_PLUGIN),
    Rule { supported: "class", ..rule("default", "mujoco default") },
    ignored("mesh", "default", "no meshes are read"),
    ignored("texture", "default asset", LOOKS),
    ignored("material", "default asset", LOOKS),
    ignored("camera", "default worldbody body frame", LOOKS),
    ignored("light", "default worldbody body frame", LOOKS),
    ignored("pair", "default", CONTACT),
    ignored(
        "asset",
        "mujoco",
        "no meshes, textures or heights are read; a geom of a mesh needs an `inertial` beside it",
    ),
    refused("deformable", "mujoco", "bodies are rigid"),
    ignored("contact", "mujoco", CONTACT),
    ignored("sensor", "mujoco", "`outputs` say what is observed"),
    ignored("keyframe", "mujoco", "`initial` says where the motion begins"),
];

pub const BODIES: &[Rule] = &[
    Rule {
        ignored: &[("name pos quat axisangle xyaxes zaxis euler", "the world is the ground"), ("childclass", "")],
        ..rule("worldbody", "mujoco")
    },
    Rule {
        supported: "name childclass pos quat axisangle xyaxes zaxis euler mocap",
        ignored: &[("user sleep simple fuse", "it does not change the motion")],
        refused: &[("gravcomp", "0", "a body has its weight: an effect `force` carries it")],
        ..rule("body", "worldbody body frame")
    },
    Rule {
        supported: "name childclass pos quat axisangle xyaxes zaxis euler",
        ..rule("frame", "worldbody body frame")
    },
    Rule {
        supported: "mass pos quat axisangle xyaxes zaxis euler diaginertia fullinertia",
        ..rule("inertial", "body")
    },
    Rule {
        supported: "name class type pos axis damping armature stiffness springref ref range limited frictionloss",
        ignored: &[
            ("group user", "it is data of other programs"),
            ("solreflimit solimplimit solreffriction solimpfriction margin", SOFT),
        ],
        refused: &[
            ("springdamper", "0 0", "give `stiffness` and `damping`"),
            ("springyield", "0", "springs do not yield"),
            ("actuatorfrcrange", "0 0", "give the actuators a `forcerange`"),
            ("actuatorfrclimited", "false", "give the actuators a `forcerange`"),
            ("actuatorgravcomp", "false", "a body has its weight: an effect `force` carries it"),
        ],
        ..rule("joint", "body default frame")
    },
    Rule {
        supported: "name",
        ignored: &[("group align", "it does not change the motion")],
        ..rule("freejoint", "body")
    },
    Rule {
        supported: "name class type size fromto pos quat axisangle xyaxes zaxis euler mass density group mesh",
        ignored: &[
            ("rgba material castshadow user hfield", LOOKS),
            (
                "contype conaffinity condim priority friction solmix solref solimp margin gap adhesion surfacevel",
                CONTACT,
            ),
            ("fluidcoef", NO_FLUID),
        ],
        refused: &[
            ("shellinertia", "false", "geoms are solid: give the body an `inertial`"),
            ("fluidshape", "none", NO_FLUID),
            ("fitscale", "1", "no meshes are read"),
        ],
        ..rule("geom", "worldbody body frame default")
    },
    Rule {
        supported: "name class pos quat axisangle xyaxes zaxis euler fromto",
        ignored: &[("type size rgba material group user mesh", LOOKS)],
        ..rule("site", "worldbody body frame default")
    },
    refused("plugin", "worldbody body geom asset actuator sensor", NO_PLUGIN),
    refused("attach", "worldbody body frame", "save the model as one file by MuJoCo first"),
    refused("replicate", "worldbody body frame", "save the model as one file by MuJoCo first"),
    refused("composite", "worldbody body frame", "save the model as one file by MuJoCo first"),
    refused("flexcomp", "worldbody body frame", "bodies are rigid"),
];

pub const COUPLINGS: &[Rule] = &[
    ignored("equality", "default", SOFT),
    Rule {
        ignored: &[
            ("group rgba width material user", LOOKS),
            (
                "solreflimit solimplimit solreffriction solimpfriction margin limited range",
                "limits of tendons are not held",
            ),
        ],
        supported: "stiffness damping springlength",
        refused: &[
            ("frictionloss", "0", "only joints have friction"),
            ("armature", "0", "only joints have rotors"),
            ("springyield", "0", "springs do not yield"),
            ("actuatorfrcrange", "0 0", "give the actuators a `forcerange`"),
            ("actuatorfrclimited", "false", "give the actuators a `forcerange`"),
        ],
        ..rule("tendon", "default")
    },
    rule("equality", "mujoco"),
    Rule {
        supported: "name class active body1 body2 anchor site1 site2",
        ignored: &[("solref solimp", SOFT)],
        ..rule("connect", "equality")
    },
    Rule {
        supported: "name class active body1 body2 relpose anchor site1 site2",
        ignored: &[("solref solimp torquescale", SOFT)],
        ..rule("weld", "equality")
    },
    Rule {
        supported: "name class active joint1 joint2 polycoef",
        ignored: &[("solref solimp", SOFT)],
        ..rule("joint", "equality")
    },
    Rule {
        supported: "name class active tendon1 tendon2 polycoef",
        ignored: &[("solref solimp", SOFT)],
        ..rule("tendon", "equality")
    },
    refused("flex", "equality", "bodies are rigid"),
    refused("flexstrain", "equality", "bodies are rigid"),
    refused("distance", "equality", "MuJoCo has it no more: the joint `distance` does this"),
    rule("tendon", "mujoco"),
    Rule {
        supported: "name class stiffness damping springlength",
        ignored: &[
            ("group user", LOOKS),
            (
                "solreflimit solimplimit solreffriction solimpfriction margin limited range",
                "limits of tendons are not held",
            ),
        ],
        refused: &[
            ("frictionloss", "0", "only joints have friction"),
            ("armature", "0", "only joints have rotors"),
            ("springyield", "0", "springs do not yield"),
            ("actuatorfrcrange", "0 0", "give the actuators a `forcerange`"),
            ("actuatorfrclimited", "false", "give the actuators a `forcerange`"),
        ],
        ..rule("fixed", "tendon")
    },
    Rule { supported: "joint coef", ..rule("joint", "fixed") },
    refused(
        "spatial",
        "tendon",
        "tendons are fixed ones: an effect `cable` or `spring_damper` acts between two points",
    ),
    rule("actuator", "mujoco"),
    Rule {
        supported: "name class joint jointinparent tendon gear ctrlrange ctrllimited forcerange forcelimited gaintype gainprm \
                    biastype biasprm dyntype",
        ignored: ACTUATOR_IGNORED,
        refused: &[
            ("site refsite body cranksite slidersite cranklength", "", TRANSMISSION),
            ("actdim actearly actlimited actrange dynprm", "", DYNAMICS),
            ("delay nsample interp", "0", DELAY),
            ("armature damping", "0", "give them to the joint"),
            ("inheritrange input ffrange velrange", "0", "give the ranges as numbers"),
        ],
        ..rule("general", "actuator default")
    },
    Rule {
        supported: "name class joint jointinparent tendon gear ctrlrange ctrllimited forcerange forcelimited",
        ignored: ACTUATOR_IGNORED,
        refused: ACTUATOR_REFUSED,
        ..rule("motor", "actuator default")
    },
    Rule {
        supported: "name class joint jointinparent tendon gear ctrlrange ctrllimited forcerange forcelimited kp kv",
        ignored: ACTUATOR_IGNORED,
        refused: &[
            ("site refsite cranksite slidersite cranklength", "", TRANSMISSION),
            ("delay nsample interp", "0", DELAY),
            ("armature damping", "0", "give them to the joint"),
            ("timeconst", "0", DYNAMICS),
            ("dampratio", "0", "give `kv`"),
            ("inheritrange", "0", "give the ranges as numbers"),
        ],
        ..rule("position", "actuator default")
    },
    Rule {
        supported: "name class joint jointinparent tendon gear ctrlrange ctrllimited forcerange forcelimited kv",
        ignored: ACTUATOR_IGNORED,
        refused: ACTUATOR_REFUSED,
        ..rule("velocity", "actuator default")
    },
    Rule {
        supported: "name class joint jointinparent tendon gear ctrlrange ctrllimited forcerange forcelimited kv",
        ignored: ACTUATOR_IGNORED,
        refused: ACTUATOR_REFUSED,
        ..rule("damper", "actuator default")
    },
    refused("intvelocity", "actuator", DYNAMICS),
    refused("orientation", "actuator", "actuators act on joints of one coordinate"),
    refused("pid", "actuator", DYNAMICS),
    refused("cylinder", "actuator", DYNAMICS),
    refused("muscle", "actuator", DYNAMICS),
    refused("dcmotor", "actuator", DYNAMICS),
    refused("adhesion", "actuator", CONTACT),
    ignored("intvelocity", "default", "actuators of this kind are refused"),
    ignored("orientation", "default", "actuators of this kind are refused"),
    ignored("pid", "default", "actuators of this kind are refused"),
    ignored("cylinder", "default", "actuators of this kind are refused"),
    ignored("muscle", "default", "actuators of this kind are refused"),
    ignored("dcmotor", "default", "actuators of this kind are refused"),
    ignored("adhesion", "default", "actuators of this kind are refused"),
];

const ACTUATOR_IGNORED: &[(&str, &str)] = &[("group user lengthrange", "it does not change the motion")];
const ACTUATOR_REFUSED: &[(&str, &str, &str)] = &[
    ("site refsite cranksite slidersite cranklength", "", TRANSMISSION),
    ("delay nsample interp", "0", DELAY),
    ("armature damping", "0", "give them to the joint"),
];
