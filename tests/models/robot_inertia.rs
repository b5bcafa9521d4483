//! Whatever of a robot's file carries inertia counts: links without mass, inertials without inertia, meshes. Closed
//! forms: α = M/J about a hinge, a tensor turned with its link, Steiner, boxes and prisms.

use std::path::Path;

use mbint::{Error, Model};

use crate::common::{curve, nominal};

/// A robot, perhaps with other files next to it, and the model that names it.
struct Robot {
    folder: tempfile::TempDir,
    file: &'static str,
}

impl Robot {
    fn new(file: &'static str, text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(file), text).unwrap();
        Self { folder, file }
    }

    fn reading(&self, yaml: &str) -> Result<Model, Error> {
        let kind = if Path::new(self.file).extension().is_some_and(|known| known == "urdf") { "urdf" } else { "mjcf" };
        let simulation = "simulation: { duration: 1e-3, step: 1e-3, output_step: 1e-3 }";
        let text = format!("{kind}: {}\n{yaml}\n{simulation}\n", self.file);
        Model::from_yaml_str(&self.folder.path().join("model.yaml").display().to_string(), &text)
    }

    /// The first value of the output `a`.
    #[track_caller]
    fn first(&self, yaml: &str) -> f64 {
        let model = self.reading(yaml).unwrap_or_else(|error| panic!("{error}"));
        curve(&nominal(&model.into()), "a")[0]
    }

    /// Moments of a body about the axes of its file's frame, by a moment of 1 N m about a hinge along each.
    #[track_caller]
    fn moments(text: &str) -> [f64; 3] {
        ["1 0 0", "0 1 0", "0 0 1"].map(|axis| {
            let robot = Self::new("robot.xml", &text.replace("AXIS", axis));
            1.0 / robot.first(TORQUE)
        })
    }
}

const TORQUE: &str = "effects: { gravity: { gravity: { acceleration: [0, 0, 0] } }, push: { preload: { on: j, value: 1 } } }\n\
                      outputs: { a: j.angular_acceleration }";

fn link(name: &str, mass: f64, inertial: &str, [xx, yy, zz]: [f64; 3]) -> String {
    format!(
        "<link name='{name}'><inertial>{inertial}<mass value='{mass}'/>\
         <inertia ixx='{xx}' iyy='{yy}' izz='{zz}' ixy='0' ixz='0' iyz='0'/></inertial></link>"
    )
}

fn joint(name: &str, kind: &str, [parent, child]: [&str; 2], origin: &str) -> String {
    format!(
        "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>{origin}<axis xyz='0 1 0'/></joint>"
    )
}

fn urdf(parts: &[String]) -> Robot {
    Robot::new("robot.urdf", &format!("<robot name='r'><link name='w'/>{}</robot>", parts.concat()))
}

#[track_caller]
fn near(found: f64, exact: f64) {
    assert!((found - exact).abs() < 1e-9 * exact.abs(), "{found} for {exact}");
}

#[test]
fn welded_links_without_mass_keep_their_inertia() {
    let robot = urdf(&[
        link("a", 1.0, "<origin xyz='0.1 0 0'/>", [0.01; 3]),
        link("f", 0.0, "", [0.03, 0.02, 0.04]),
        link("g", 0.0, "<origin xyz='1 2 3'/>", [0.005; 3]),
        joint("j", "continuous", ["w", "a"], ""),
        joint("k", "fixed", ["a", "f"], "<origin xyz='0.3 0 0' rpy='0.5 0 0'/>"),
        joint("l", "fixed", ["f", "g"], "<origin xyz='0 1 0'/>"),
    ]);
    let [sin, cos] = [0.5_f64.sin(), 0.5_f64.cos()];
    let moment = 0.01 + 0.01 + 0.02 * cos * cos + 0.04 * sin * sin + 0.005;
    near(robot.first(TORQUE), 1.0 / moment);
    let named = robot.first(&format!("parameters: {{ link.f.inertia.yy: 10%, link.g.mass: [0, 0.1] }}\n{TORQUE}"));
    near(named, 1.0 / moment);
}

#[test]
fn a_link_without_mass_turns_against_its_inertia() {
    let robot = urdf(&[
        link("a", 1.0, "", [0.01; 3]),
        link("b", 0.0, "<origin xyz='7 0 0'/>", [0.02; 3]),
        joint("i", "continuous", ["w", "a"], ""),
        joint("j", "continuous", ["a", "b"], "<origin xyz='0.4 0 0'/>"),
    ]);
    near(robot.first(TORQUE), 1.0 / 0.02 + 1.0 / 0.01);
}

/// About such an axis, or along a slide, the equations would be singular.
#[test]
fn missing_mass_is_replaced_with_a_warning() {
    for (kind, moments) in [("prismatic", [0.02; 3]), ("continuous", [0.02, 0.0, 0.02])] {
        let robot = urdf(&[link("a", 0.0, "<origin xyz='0.5 0 0'/>", moments), joint("j", kind, ["w", "a"], "")]);
        let model = robot.reading("outputs: { a: a.y }").unwrap_or_else(|error| panic!("{error}"));
        let message = model.warnings().to_string();
        assert!(message.contains("link `a` moves, but has no mass: 0.001 kg is taken"), "{message}");
    }
}

#[test]
fn an_inertial_without_inertia_is_a_point() {
    let robot = Robot::new(
        "robot.xml",
        "<mujoco><worldbody><body name='a'><joint name='j' axis='0 1 0'/><inertial mass='2' pos='0.5 0 0'/>\
         <body pos='0 0 1'><inertial mass='0' pos='9 9 9' diaginertia='0.1 0.2 0.3'/></body></body></worldbody></mujoco>",
    );
    near(robot.first(TORQUE), 1.0 / (2.0 * 0.25 + 0.2));
}

/// A box of half sizes 0.1, 0.2 and 0.3 about its middle, as a file of each format.
fn write_boxes(folder: &Path) {
    let corner = |index: usize| {
        [0.1, 0.2, 0.3].iter().enumerate().map(move |(i, half)| if index >> i & 1 == 1 { *half } else { -half })
    };
    let corners: Vec<Vec<f64>> = (0..8).map(|index| corner(index).collect()).collect();
    const FACES: [[usize; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let mut obj: String = corners.iter().map(|c| format!("v {} {} {}\n", c[0], c[1], c[2])).collect();
    FACES
        .iter()
        .for_each(|[a, b, c, d]| obj.push_str(&format!("f {}//1 {}//1 {}//1 {}//1\n", a + 1, b + 1, c + 1, d + 1)));
    std::fs::write(folder.join("box.obj"), obj).unwrap();
    let triangles: Vec<[usize; 3]> = FACES.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mut binary = vec![0; 80];
    binary.extend(12_u32.to_le_bytes());
    let mut text = "solid box\n".to_owned();
    for triangle in &triangles {
        binary.extend([0; 12]);
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for &index in triangle {
            binary.extend(corners[index].iter().flat_map(|part| (*part as f32).to_le_bytes()));
            text.push_str(&format!("vertex {} {} {}\n", corners[index][0], corners[index][1], corners[index][2]));
        }
        binary.extend([0; 2]);
        text.push_str("endloop\nendfacet\n");
    }
    std::fs::write(folder.join("box.stl"), binary).unwrap();
    std::fs::write(folder.join("text.STL"), text + "endsolid\n").unwrap();
    let mut msh: Vec<u8> = [8, 0, 0, 12].into_iter().flat_map(i32::to_le_bytes).collect();
    msh.extend(corners.iter().flatten().flat_map(|part| (*part as f32).to_le_bytes()));
    msh.extend(triangles.iter().flatten().flat_map(|index| (*index as i32).to_le_bytes()));
    std::fs::write(folder.join("box.msh"), msh).unwrap();
}

fn of_mesh(mesh: &str, geom: &str) -> String {
    format!(
        "<mujoco><compiler meshdir='meshes'/><asset><mesh name='m' {mesh}/></asset><worldbody><body name='a'>\
         <joint name='j' axis='0 1 0'/><geom type='mesh' mesh='m' contype='0' conaffinity='0' {geom}/></body></worldbody></mujoco>"
    )
}

#[test]
fn a_box_of_any_format_has_the_inertia_of_a_box() {
    // 500 kg/m³ · 0.048 m³, moved by 0.5 along x; a hinge along y.
    let mass = 500.0 * 0.048;
    let exact = mass * ((0.01 + 0.09) / 3.0 + 0.25);
    for file in ["box.obj", "box.stl", "text.STL", "box.msh"] {
        for inertia in ["", "inertia='exact'"] {
            let text = of_mesh(&format!("file='{file}' {inertia}"), "pos='0.5 0 0' density='500'");
            let robot = Robot::new("robot.xml", &text);
            let folder = robot.folder.path().join("meshes");
            std::fs::create_dir(&folder).unwrap();
            write_boxes(&folder);
            let found = 1.0 / robot.first(TORQUE);
            assert!((found - exact).abs() < 1e-6 * exact, "{file}: {found} for {exact}");
        }
    }
}

/// Three unit cubes in an angle; its inertia by MuJoCo 4.0 with each `inertia`, moved and scaled.
#[test]
fn an_angle_has_the_inertia_that_mujoco_computes() {
    const CORNERS: &str = "0 0 0 2 0 0 2 1 0 1 1 0 1 2 0 0 2 0 0 0 1 2 0 1 2 1 1 1 1 1 1 2 1 0 2 1";
    const FACES: &str = "6 7 8 6 8 9 6 9 10 6 10 11 2 1 0 3 2 0 4 3 0 5 4 0 \
                         0 1 7 0 7 6 1 2 8 1 8 7 2 3 9 2 9 8 3 4 10 3 10 9 4 5 11 4 11 10 5 0 6 5 6 11";
    let moments = |more: &str| {
        let mesh = format!("vertex='{CORNERS}' face='{FACES}' {more}");
        Robot::moments(&of_mesh(&mesh, "density='1'").replace("axis='0 1 0'", "axis='AXIS'"))
    };
    // About the frame: J + m (d² 1 − d dᵀ).
    let about_frame = |mass: f64, [x, y, z]: [f64; 3], [xx, yy, zz]: [f64; 3]| {
        [xx + mass * (y * y + z * z), yy + mass * (x * x + z * z), zz + mass * (x * x + y * y)]
    };
    let near = |found: [f64; 3], exact: [f64; 3]| {
        (0..3).for_each(|i| assert!((found[i] - exact[i]).abs() < 1e-4, "{found:?} for {exact:?}"));
    };
    let solid = about_frame(3.0, [5.0 / 6.0, 5.0 / 6.0, 0.5], [7.0 / 6.0, 7.0 / 6.0, 11.0 / 6.0]);
    near(moments(""), solid);
    near(moments("inertia='exact'"), solid);
    near(moments("inertia='shell'"), about_frame(14.0, [6.0 / 7.0, 6.0 / 7.0, 0.5], [8.21429, 8.21429, 12.09524]));
    let turned = about_frame(6.0, [5.0 / 3.0, 1.0 / 6.0, 0.5], [2.33333, 7.83333, 9.16667]);
    near(moments("inertia='exact' refpos='1 0 0' scale='2 1 1' refquat='0.70710678 0 0 0.70710678'"), turned);
}

#[test]
fn faulty_meshes_are_reported() {
    let says = |mesh: &str, message: &str| {
        let found = Robot::new("robot.xml", &of_mesh(mesh, "")).reading("");
        let found = found.map_or_else(|error| error.to_string(), |model| model.warnings().to_string());
        assert!(found.contains(message), "{mesh}: {found}");
    };
    const TETRAHEDRON: &str = "vertex='0 0 0 1 0 0 0 1 0 0 0 1'";
    let of = |faces: &str, more: &str| format!("{TETRAHEDRON} face='{faces}' {more}");
    says(
        &of("0 2 1 0 1 3 0 3 2", ""),
        "no closed surface: its inertia is that of tetrahedra to its middle, as MuJoCo has it (mesh `m`: 3 of its edges",
    );
    says(
        &of("0 2 1 0 1 3 0 3 2", "inertia='exact'"),
        "mesh `m` encloses no volume: 3 of its edges are of one triangle only",
    );
    says(
        &of("0 1 2 0 1 3 0 3 2 1 2 3", "inertia='exact'"),
        "along 3 of its edges neighbours are turned against one another",
    );
    says(&of("0 1 2 0 3 1 0 2 3 1 3 2", "inertia='exact'"), "its triangles are turned inwards");
    says(&of("0 2 1 0 1 3 0 3 2 1 2 4", ""), "`face` has three places of corners");
    says(&of("0 2 1", "inertia='convex'"), "the inertia of a mesh's convex hull is not computed");
    says(TETRAHEDRON, "`<mesh>` needs `file`, or `vertex` and `face`");
    says("file='none.stl'", "the mesh `none.stl` cannot be read");
    says("file='../../none.stl'", "is not within the model's folder");
    // A deep cup: its middle sees its wall twice.
    let cup = "vertex='0 0 0 3 0 0 0 3 0 0 0 3 0.1 0.1 0.1' face='0 2 1 0 1 3 0 3 2 1 2 4 2 3 4 3 1 4'";
    says(cup, "are more than it encloses (mesh `m`:");
}
