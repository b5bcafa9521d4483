//! The elements of MJCF, from <https://mujoco.readthedocs.io/en/stable/XMLreference.html> and the schema that MuJoCo
//! 4.0 prints.

use super::format::Fate::{Ignored, Refused, Supported};
use super::format::Rule;

const SOFT: &str = "constraints are rigid, and stops are as `limits` says";
const LOOKS: &str = "it is appearance";
const CONTACT: &str = "contacts of geoms are ignored: an effect `contact` says which surfaces touch";
const SOLVER: &str = "mbint has its own integration, as `simulation` says";
const NO_FLUID: &str = "there is no fluid: the effect `drag` resists";
const NO_PLUGIN: &str = "the file does not contain the plugin's code";
const FIT: &str = "shapes are not fitted to meshes";
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
        ..rule("include", "mujoco worldbody body frame replicate default asset actuator tendon equality contact sensor")
    },
    Rule {
        supported: "angle autolimits balanceinertia boundinertia boundmass coordinate eulerseq inertiafromgeom \
                    inertiagrouprange settotalmass assetdir meshdir strippath",
        ignored: &[
            ("texturedir", LOOKS),
            (
                "alignfree fusestatic discardvisual usethread convexhull saveinertial savecanonical savecompiled conflict \
              passthrough",
                "it does not change the motion",
            ),
        ],
        refused: &[("fitaabb", "false", FIT)],
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
    Rule {
        supported: "name class file vertex face scale refpos refquat inertia",
        ignored: &[(
            "normal texcoord smoothnormal maxhullvert octreedepth needsdf content_type material",
            "it does not change the motion",
        )],
        refused: &[("builtin params", "", "only files, or `vertex` and `face`, are read")],
        ..rule("mesh", "default asset")
    },
    ignored("texture", "default asset", LOOKS),
    ignored("material", "default asset", LOOKS),
    ignored("camera", "default worldbody body frame replicate", LOOKS),
    ignored("light", "default worldbody body frame replicate", LOOKS),
    ignored("pair", "default", CONTACT),
    rule("asset", "mujoco"),
    ignored("hfield", "asset", CONTACT),
    ignored("skin", "asset", LOOKS),
    Rule { supported: "name file", ignored: &[("content_type", "it is of the file's name")], ..rule("model", "asset") },
    refused("deformable", "mujoco", "bodies are rigid"),
    ignored("contact", "mujoco", CONTACT),
    ignored("sensor", "mujoco", "`outputs` name the observed quantities"),
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
        ..rule("body", "worldbody body frame replicate")
    },
    Rule {
        supported: "name childclass pos quat axisangle xyaxes zaxis euler",
        ..rule("frame", "worldbody body frame replicate")
    },
    Rule {
        supported: "mass pos quat axisangle xyaxes zaxis euler diaginertia fullinertia",
        ..rule("inertial", "body")
    },
    Rule {
        supported: "name class type pos axis damping armature stiffness springref springdamper ref range limited frictionloss \
                    actuatorfrcrange actuatorfrclimited",
        ignored: &[
            ("group user", "it is data of other programs"),
            ("solreflimit solimplimit solreffriction solimpfriction margin", SOFT),
        ],
        refused: &[
            ("springyield", "0", "springs do not yield"),
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
            ("fitscale", "1", FIT),
        ],
        ..rule("geom", "worldbody body frame replicate default")
    },
    Rule {
        supported: "name class pos quat axisangle xyaxes zaxis euler fromto",
        ignored: &[("type size rgba material group user mesh", LOOKS)],
        ..rule("site", "worldbody body frame replicate default")
    },
    refused("plugin", "worldbody body geom asset actuator sensor", NO_PLUGIN),
    Rule { supported: "model body prefix", ..rule("attach", "worldbody body frame replicate") },
    Rule { supported: "count offset euler sep", ..rule("replicate", "worldbody body frame replicate") },
    refused("composite", "worldbody body frame replicate", "save the model as one file by MuJoCo first"),
    refused("flexcomp", "worldbody body frame replicate", "bodies are rigid"),
];

pub const COUPLINGS: &[Rule] = &[
    ignored("equality", "default", SOFT),
    Rule {
        ignored: &[
            ("group rgba width material user", LOOKS),
            (
                "solreflimit solimplimit solreffriction solimpfriction margin limited range",
                "limits of tendons have no effect",
            ),
        ],
        supported: "stiffness damping springlength frictionloss",
        refused: &[
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
        supported: "name class stiffness damping springlength frictionloss",
        ignored: &[
            ("group user", LOOKS),
            (
                "solreflimit solimplimit solreffriction solimpfriction margin limited range",
                "limits of tendons have no effect",
            ),
        ],
        refused: &[
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
                    biastype biasprm dyntype dynprm",
        ignored: GENERAL_IGNORED,
        refused: &[
            ("site refsite body cranksite slidersite cranklength", "", TRANSMISSION),
            ("actdim actlimited actrange", "", DYNAMICS),
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
        supported: "name class joint jointinparent tendon gear ctrlrange ctrllimited forcerange forcelimited kp kv \
                    dampratio timeconst inheritrange",
        ignored: ACTUATOR_IGNORED,
        refused: &[
            ("site refsite cranksite slidersite cranklength", "", TRANSMISSION),
            ("delay nsample interp", "0", DELAY),
            ("armature damping", "0", "give them to the joint"),
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
    Rule {
        supported: "name class joint jointinparent tendon gear ctrlrange ctrllimited forcerange forcelimited timeconst area \
                    diameter bias",
        ignored: ACTUATOR_IGNORED,
        refused: ACTUATOR_REFUSED,
        ..rule("cylinder", "actuator default")
    },
    refused("muscle", "actuator", DYNAMICS),
    refused("dcmotor", "actuator", DYNAMICS),
    ignored("adhesion", "actuator", CONTACT),
    ignored("intvelocity", "default", "actuators of this kind are refused"),
    ignored("orientation", "default", "actuators of this kind are refused"),
    ignored("pid", "default", "actuators of this kind are refused"),
    ignored("muscle", "default", "actuators of this kind are refused"),
    ignored("dcmotor", "default", "actuators of this kind are refused"),
    ignored("adhesion", "default", CONTACT),
];

const GENERAL_IGNORED: &[(&str, &str)] =
    &[("group user lengthrange", "it does not change the motion"), ("actearly", SOLVER)];
const ACTUATOR_IGNORED: &[(&str, &str)] = &[("group user lengthrange", "it does not change the motion")];
const ACTUATOR_REFUSED: &[(&str, &str, &str)] = &[
    ("site refsite cranksite slidersite cranklength", "", TRANSMISSION),
    ("delay nsample interp", "0", DELAY),
    ("armature damping", "0", "give them to the joint"),
];
