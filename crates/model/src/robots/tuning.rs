//! Constants of the room `robots`.

use symdiff::constants::tuning;

tuning! {
    /// Files of robots.
    "robots" {
        /// Largest file of a robot, bytes; meshes are files of their own.
        file_bytes: u64 = 50_000_000, moves "which robots are refused";
        /// Most elements, comments and pieces of text of an XML file.
        xml_nodes: u32 = 1_000_000, moves "which robots are refused";
        /// Deepest nesting of elements of a file; a robot has six levels.
        xml_levels: usize = 100, moves "which robots are refused";
        /// Most attributes of an element; a robot has ten.
        xml_attributes: usize = 100, moves "which robots are refused";
        /// Most elements of a file, and most attributes; a humanoid with all its meshes has a few thousand.
        xml_items: usize = 200_000, moves "which robots are refused";
        /// Most prefixes that a file leaves undeclared: for each the text is parsed once more.
        xml_prefixes: usize = 20, moves "which robots are refused";
        /// Most files that an MJCF includes.
        mjcf_files: usize = 100, moves "which robots are refused";
        /// Most elements of an MJCF with its included files.
        mjcf_items: usize = 200_000, moves "which robots are refused";
        /// Deepest nesting of elements of an MJCF with its included files.
        mjcf_levels: usize = 200, moves "which robots are refused";
        /// Most copies that `<attach>` and `<replicate>` make, those within copies included.
        mjcf_copies: usize = 10_000, moves "which robots are refused";
        /// Share of the enclosed volume by which the sum of a mesh's tetrahedra may exceed it without a warning.
        mesh_excess: f64 = 0.01, moves "warnings of open meshes";
        /// Density of a geom that has none: of water, as in MuJoCo, kg/m³.
        density: f64 = 1000.0, moves "masses of robots";
        /// Velocity at which dry friction of a rotating joint has 71 % of its size, rad/s.
        slow_turn: f64 = 0.05, moves "bounds of robots with friction";
        /// Velocity at which dry friction of a sliding joint has 71 % of its size, m/s.
        slow_slide: f64 = 0.01, moves "bounds of robots with friction";
    }
}
