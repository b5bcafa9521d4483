//! Constants of the room `elements`.

use symdiff::constants::tuning;

tuning! {
    /// Effects, joints and shapes.
    "elements" {
        /// Angle over which teeth come to bear, over the play.
        bearing_of_teeth: f64 = 1e-2, moves "bounds of models with backlash";
        /// Smallest angle over which teeth come to bear, rad.
        sharpest_bearing: f64 = 1e-7, moves "bounds of models with backlash";
        /// Stretch over which a strand becomes taut, over the first radius.
        taut_belt: f64 = 1e-4, moves "bounds of models with belts";
        /// Stretch over which a cable becomes taut, over its length.
        taut_cable: f64 = 1e-4, moves "bounds of models with cables";
        /// s over M, in the equations of contacts between lines and hulls.
        smooth_lines_of_hull: f64 = 1e-4, moves "bounds of models with contacts of hulls";
        /// Square of the sine of the angle between a line and an edge below which they do not cross.
        crossing_lines: f64 = 1e-8, moves "bounds of models with contacts of hulls";
        /// Features meet within this share of the hull's size.
        meeting_features: f64 = 1e-9, moves "bounds of models with contacts of hulls";
        /// The distance from the middle of an arc under the root, over R: it moves the arc by 5e-9 R.
        centred_arc: f64 = 1e-4, moves "bounds of models with contacts of arcs";
        /// Angle of a line to a face within which it counts as parallel.
        line_along_face: f64 = 1e-4, moves "bounds of models with contacts of boxes";
        /// Square of a component of a unit vector below which it passes no plane.
        no_passing: f64 = 1e-30, moves "bounds of models with contacts of boxes";
        /// ε of a face and a plane, in the equations of contacts of cylinders.
        flat_face: f64 = 1e-3, moves "bounds of models with contacts of cylinders";
        /// Angle of a line to a face or the side below which it counts as parallel.
        line_along_cylinder: f64 = 1e-4, moves "bounds of models with contacts of cylinders";
        /// Halvings of a line in the search for its point nearest to a cylinder.
        halvings_of_line: i32 = 16, moves "bounds of models with contacts of cylinders";
        /// Square of the sine or cosine of an angle that counts as none.
        no_angle: f64 = 1e-30, moves "bounds of models with contacts of cylinders";
        /// Lengths as shares of the reach: normals of faces that are this equally far from a body are mixed.
        mixed_normals: f64 = 0.1, moves "bounds of models with contacts of boxes";
        /// Steps of Newton's method to the nearest point of ground.
        steps_to_ground: usize = 3, moves "bounds of models with contacts of ground";
        /// Most points: each face, edge and corner has instructions of its own.
        points_of_hull: usize = 32, moves "which hulls are refused";
        /// Points within this share of the hull's size from a plane lie in it.
        points_of_plane: f64 = 1e-9, moves "which hulls are refused";
        /// Turns of less than this at a corner are none, over the outline's reach.
        smooth_corner: f64 = 1e-6, moves "bounds of models with contacts of outlines";
        /// Most pairs of edges: each has instructions of its own. Two boxes have 144.
        pairs_of_edges: usize = 400, moves "which contacts are refused";
        /// ε of two rods, in the equations of their contact.
        parallel_rods: f64 = 1e-4, moves "bounds of models with contacts of rods";
        /// Most corners of one contact: each has instructions of its own.
        corners_of_contact: usize = 256, moves "which contacts are refused";
        /// Straight pieces of ground that a drawing shows.
        pieces_of_ground: u32 = 160, moves "drawings and reports of ground";
        /// ε over R − r, in the equations of contacts of circles within one another.
        centred_touch: f64 = 1e-4, moves "bounds of models with contacts of circles";
        /// Order n of a delay that gives none.
        order_of_delay: usize = 5, moves "bounds of models with delays";
        /// Largest order n of a delay.
        most_order_of_delay: usize = 8, moves "which models are refused";
        /// ε of the speed, in the equation of drag, m/s.
        drag_at_rest: f64 = 1e-6, moves "bounds of models with drag";
        /// ε of a joint's load, in the equation of its friction, N.
        no_load_of_joint: f64 = 1e-6, moves "bounds of models with friction";
        /// ε over L, in the equation of saturation.
        corner_of_saturation: f64 = 0.01, moves "bounds of models with saturations";
        /// Points nearer than this coincide for a damper of no free length, m. Its square is lost in rounding when
        /// added to that of a length of 0.1 µm.
        coincident_points: f64 = 1e-15, moves "bounds of models with dampers";
        /// Share of the largest stiffness below which a stiffness counts as zero.
        no_stiffness: f64 = 1e-9, moves "which superelements are refused";
        /// Most modes of a body.
        most_modes: usize = 100, moves "which superelements are refused";
        /// Share of the sum of its terms that a number may be off which has to vanish.
        rounding_of_matrices: f64 = 1e-4, moves "which superelements are refused";
        /// ε of a tooth's load, in the equation of its friction, N m or N.
        no_load_of_teeth: f64 = 1e-6, moves "bounds of models with friction";
        /// Added under the square root of the slip, so that it has a derivative at no slip.
        no_slip: f64 = 1e-12, moves "bounds of models with tyres";
        /// Sines of angles and relative distances below this are zero.
        aligned: f64 = 1e-9, moves "which pairs of teeth are refused";
        /// Pressure angle of a worm that gives none, degrees.
        pressure_of_worm: f64 = 20.0, moves "worms whose pressure angle is not given";
        /// Exponents of the law of ν in a bin that are zero.
        no_exponent: f64 = 1e-9, moves "realisations of random excitations";
        /// Shares of a move that two ramps leave are none below this.
        negligible_share: f64 = 1e-9, moves "shapes of trajectories";
    }
}
