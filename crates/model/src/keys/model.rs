//! The whole, its scenes, parameters and tables.

use indexmap::IndexMap;
use schemars::JsonSchema;

use super::*;
use crate::elements::JointKind;
use crate::elements::effects::{EffectKind, Impact, State};

grammar! {
    /// A mechanism, its uncertain parameters, and the questions to it.
    File is "a model" {
        /// Short name; by default the file's.
        model: Option<String>,
        /// One line for people.
        description: Option<String>,
        /// Whether the mechanism stays in the plane; by default it does where nothing in the file leaves it.
        space: Option<SpaceName>,
        /// A robot to begin with: a URDF file, next to this one. Its links are bodies, its numbers parameters.
        urdf: Option<String>,
        /// Whether the robot's root link is fixed to the ground, which is the default.
        base: Option<BaseName>,
        /// A robot to begin with: an MJCF file (MuJoCo's XML), next to this one. Its bodies are bodies, its numbers
        /// parameters.
        mjcf: Option<String>,
        /// Commands to the actuators of the `mjcf`, by name: numbers, or formulas of t and the motion.
        controls: Option<IndexMap<String, Number>>,
        /// Named numbers; those with a tolerance or an interval are uncertain.
        parameters: Option<IndexMap<String, ParameterFile>>,
        /// Dimensions between faces, by name: parameters, and chains of them that close in a gap.
        dimensions: Option<IndexMap<String, DimensionFile>>,
        /// Zones of deviations, by name: each is one cause. Formulas have its deviations as parameters.
        zones: Option<IndexMap<String, ZoneFile>>,
        /// Files of assemblies, next to this one or below.
        include: Option<IncludeFile>,
        /// Mechanisms that the model has instances of.
        assemblies: Option<IndexMap<String, Assembly>>,
        /// Copies of assemblies, whose parts are called after them: `front_left.upright.x`.
        instances: Option<IndexMap<String, InstanceFile>>,
        /// Functions given by their values: in formulas, `NAME(t)`.
        tables: Option<IndexMap<String, Table>>,
        /// Functions of the time by points that they pass: `NAME`, `NAME.rate` and `NAME.acceleration` in formulas.
        trajectories: Option<IndexMap<String, Trajectory>>,
        /// Functions of the time of which only limits are known: `NAME` in formulas, and `NAME.rate` of those with a
        /// rate.
        excitations: Option<IndexMap<String, Excitation>>,
        /// Bodies, rigid or beams. `ground` is there already, and may be given points.
        bodies: Option<IndexMap<String, Body>>,
        /// Joints, which constrain the bodies.
        joints: Option<IndexMap<String, JointKind>>,
        /// Effects, which move the bodies.
        effects: Option<IndexMap<String, EffectKind>>,
        /// Numbers that change as formulas say, in addition to the motion: integrals, currents, a controller's memory.
        states: Option<IndexMap<String, State>>,
        /// Analysis of the mechanism; by default its `motion`.
        analysis: Option<AnalysisName>,
        /// A program that answers instead of a mechanism: the model then has parameters and outputs, and no bodies.
        black_box: Option<BlackBoxFile>,
        /// Questions of `analysis: modes`.
        modes: Option<Modes>,
        /// Coordinates and velocities at the start, e.g. `crank.angle: 30 deg`; assembly finds the others. Or
        /// `equilibrium`.
        initial: Option<InitialFile>,
        /// Coordinates from which assembly starts its search, e.g. `rocker.angle: 60 deg`.
        guess: Option<IndexMap<String, StartFile>>,
        /// Outputs: names with formulas, e.g. `x3: slider.x`, or reduced to one number a motion, e.g.
        /// `stroke: { range: slider.x }`.
        outputs: Option<IndexMap<String, OutputFile>>,
        /// Requirements on outputs: names with comparisons, e.g. `clears: x3 >= 0.4 m`.
        requirements: Option<IndexMap<String, RequirementFile>>,
        /// Parameters whose nominal values `mbint design` chooses, with ranges, e.g. `rod: 0.2 to 0.3 m`. Tolerances go
        /// with the values.
        design: Option<IndexMap<String, DesignRange>>,
        /// Objective of `mbint design`.
        objective: Option<ObjectiveFile>,
        /// How long, and in which steps; `analysis: statics` needs none.
        simulation: Option<Simulation>,
        /// Bounds to compute; without this, Chebyshev of order 5.
        bounds: Option<crate::methods::keys::Bounds>,
        /// Distributions of the outputs, in addition to their bounds.
        statistics: Option<Statistics>,
        /// Makes stops of the limits of the robot's joints; by default they do nothing.
        limits: Option<Limits>,
        /// Omitted parts: effects, joints and outputs by name, or `all` effects. A scene can put them in.
        without: Option<Without>,
        /// Named variants of this model; `mbint run` runs each of them instead of it.
        scenes: Option<IndexMap<String, Scene>>,
    }

    /// A variant of the model: keys not given here are those of the model.
    Scene is "a scene" {
        /// One line for people.
        description: Option<String>,
        /// A scene whose changes come first.
        extends: Option<String>,
        /// Omitted parts: effects, joints and outputs by name, or `all` effects.
        without: Option<Without>,
        /// Parts that are in although the model, the extended scene or this one's `without` omits them.
        with: Option<Vec<String>>,
        /// New values of the model's parameters, in the model's units.
        parameters: Option<IndexMap<String, ParameterFile>>,
        /// Instead of the model's of the same name, or on top.
        joints: Option<IndexMap<String, JointKind>>,
        /// Instead of the model's of the same name, or on top.
        effects: Option<IndexMap<String, EffectKind>>,
        /// Instead of the model's of the same name, or on top.
        states: Option<IndexMap<String, State>>,
        /// Instead of the model's.
        analysis: Option<AnalysisName>,
        /// Instead of the model's.
        modes: Option<Modes>,
        /// Instead of the model's of the same name, or on top; `equilibrium` stands instead of all.
        initial: Option<InitialFile>,
        /// Instead of the model's of the same name, or on top.
        guess: Option<IndexMap<String, StartFile>>,
        /// Instead of the model's of the same name, or on top.
        outputs: Option<IndexMap<String, OutputFile>>,
        /// Instead of the model's of the same name, or on top.
        requirements: Option<IndexMap<String, RequirementFile>>,
        /// Keys that are not as in the model.
        simulation: Option<SceneSimulation>,
        /// Instead of the model's.
        bounds: Option<crate::methods::keys::Bounds>,
        /// Instead of the model's.
        statistics: Option<Statistics>,
        /// Instead of the model's.
        limits: Option<Limits>,
    }

    /// How time is stepped in a scene.
    SceneSimulation is "`simulation`" {
        /// Duration of the motion, s.
        duration: Option<Number>,
        /// Length of every step, s; instead of a `tolerance` of the model.
        step: Option<Number>,
        /// Instead of `step`: error that the steps may leave in every output, relative to how far it moves in the run;
        /// every sample keeps it, and steps end at events.
        tolerance: Option<Number>,
        /// HHT parameter from -1/3 to below 0.
        alpha: Option<Number>,
        /// Time between rows of output, s.
        output_step: Option<Number>,
        /// Coordinates that describe the motion. With `joint`, one joint of each loop is a constraint: the one with
        /// which a step is shortest.
        formulation: Option<FormulationName>,
        /// Scheme that integrates the motion.
        scheme: Option<SchemeName>,
        /// Number of step lengths, each half the one before, to combine for an order one higher: 2, 3 or 4.
        extrapolation: Option<u32>,
    }

    /// Questions of `analysis: modes`.
    Modes is "`modes`" {
        /// Where; by default at the `start`.
        at: Option<LinearisedAtName>,
        /// How many modes are reported, the slowest first; by default 6.
        number: Option<u32>,
        /// Responses to harmonic loads, by name.
        responses: Option<IndexMap<String, Response>>,
    }

    /// Response of an output to a harmonic load of 1 N, or 1 N m.
    Response is "a response" {
        /// The output along which the load acts, a length or an angle: the load does work on the quantity that it
        /// measures.
        load: String,
        /// The output that is observed.
        output: String,
        /// Least frequency, Hz.
        from: Number,
        /// Largest frequency, Hz.
        to: Number,
        /// Number of frequencies, by equal factors; by default 60.
        points: Option<u32>,
    }

    /// Stops at the limits of a robot's joints.
    Limits is "`limits`" {
        /// How they push back.
        impact: Impact,
    }

    /// A parameter; deterministic unless it has a tolerance, an interval, or plus and minus.
    Parameter is "a parameter" {
        /// Its nominal value, perhaps with its deviation: `0.5 m ± 1%`.
        value: Option<Number>,
        /// Unit of the bare numbers given here, e.g. `mm` or `N*s/m`.
        unit: Option<UnitName>,
        /// Largest deviation either way: `1%` of the value, or a quantity; or `+0.01 -0.02`.
        tolerance: Option<Number>,
        /// Smallest and largest value, also as `[490, 510] mm` in quotes; without `value`, the nominal is the middle.
        interval: Option<IntervalFile>,
        /// Largest deviation upwards.
        plus: Option<Number>,
        /// Largest deviation downwards.
        minus: Option<Number>,
        /// How it is distributed, for statistics; by default uniformly over its interval.
        distribution: Option<LawFile>,
        /// Cost of its tolerance, for `mbint allocate`.
        cost: Option<CostFile>,
        /// Description for people.
        description: Option<String>,
    }

    /// A function of the time by points that it passes; it rests before the first and after the last.
    Trajectory is "a trajectory" {
        /// Pairs of a time and a value, times ascending; with timing `cubic` or `quintic` a third number is the rate
        /// there, else 0.
        points: Vec<WaypointFile>,
        /// How it moves from one point to the next.
        timing: TimingName,
        /// With timing `trapezoidal`: how long it takes to reach its full rate, and again to rest, s; by default a
        /// quarter of each move.
        ramp: Option<Number>,
    }

    /// Any function of the time within limits, or a random one.
    Excitation is "an excitation" {
        /// Limits of its value: `± 5 N`, `20 N ± 10%`, or `[lower, upper]`; formulas of t and parameters.
        within: Option<WithinFile>,
        /// Limit of its rate, either way; without `within` it begins at 0.
        rate: Option<Number>,
        /// It is constant over each period of this length, s, and jumps between them.
        held: Option<Number>,
        /// Its mean over the duration: `0 N`, or an interval of it, `0 N ± 1 N`; a formula of parameters.
        mean: Option<MeanFile>,
        /// Largest integral of its squared distance from the middle of its limits, or from 0, over the duration:
        /// `4 N^2*s`; a formula of parameters.
        energy: Option<Number>,
        /// It is a sine of a frequency between these, Hz, or a mixture of such whose amplitudes add up to its limit.
        band: Option<[Number; 2]>,
        /// It is a stationary random function with this spectrum.
        random: Option<Random>,
        /// Name of a random excitation, which stands before this one, that it repeats: rear wheels meet the road of the
        /// front wheels.
        follows: Option<String>,
        /// How much later it repeats that, s; a formula of parameters.
        after: Option<Number>,
    }

    /// One-sided spectral density of a stationary random function.
    Random is "a random excitation" {
        /// Class `A` to `H` of a road (ISO 8608), or its density at a wavelength of 10 m, m³; it falls with the square
        /// of the spatial frequency.
        road: Option<RoadFile>,
        /// Speed at which the road is passed; a formula of parameters.
        speed: Option<Number>,
        /// Density that is the same at all frequencies of the band: `4 N^2*s`; a formula of parameters.
        white: Option<Number>,
        /// White noise passes this filter.
        filter: Option<SpectrumFilter>,
        /// Pairs of a frequency and a density; straight lines in logarithmic scales between them.
        density: Option<Vec<[Number; 2]>>,
        /// Least and largest frequency, Hz; of a road 1/m, by default `[0.011, 2.83]`.
        band: Option<[Number; 2]>,
        /// Cosines of which realisations are made, by default 100. Where a vibration is lightly damped, they should be
        /// nearer to each other than one over the duration.
        lines: Option<u32>,
        /// Time within which it begins smoothly, s; by default it begins at once.
        ramp: Option<Number>,
        /// Whole number that chooses the realisation of the motion; by default 1.
        seed: Option<u32>,
    }

    /// A filter of the first order, or with a damping ratio of the second.
    SpectrumFilter is "a `filter`" {
        /// Corner of a lag, or natural frequency, Hz.
        frequency: Number,
        /// Damping ratio of a filter of the second order.
        damping: Option<f64>,
    }

    /// A function of one number by its values: a natural cubic spline through them, which goes on straight beyond its
    /// ends, a periodic one, or straight lines.
    Table is "a table" {
        /// A CSV file, next to the model; `#` begins a comment.
        file: Option<String>,
        /// Names or numbers (from 1) of the file's columns with argument and value; by default the first two.
        columns: Option<[Column; 2]>,
        /// Instead of `file`: pairs of argument and value, arguments ascending.
        points: Option<Vec<[f64; 2]>>,
        /// Whether the table is one period, after which it begins anew: first and last value are the same.
        periodic: Option<bool>,
        /// How it goes from point to point; by default `cubic`.
        interpolation: Option<InterpolationName>,
        /// Units of argument and value, e.g. [ms, mm]; by default they are in SI units and fit anywhere.
        units: Option<[UnitName; 2]>,
    }
}
