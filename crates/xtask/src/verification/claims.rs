//! The claims of the report: words, and the sources of their figures.

/// A claim, worded as a numbered section.
pub struct Claim {
    /// Name of its page, and of its measurements.
    pub name: &'static str,
    pub title: &'static str,
    /// Activity by ASME V&V 10 and 20 and NAFEMS.
    pub activity: &'static str,
    pub claim: &'static str,
    pub setup: &'static str,
    pub acceptance: &'static str,
    pub scope: &'static str,
    pub sources: &'static [Source],
    pub table: Table,
}

/// Form of the table of cases.
#[derive(Clone, Copy, PartialEq)]
pub enum Table {
    /// A row for each case.
    Cases,
    /// Least and greatest of every figure, for many cases listed elsewhere or in the file of measurements.
    Extremes,
}

/// Tests of faults that mount a file system, which only an administrator may, and one that is a source of its own.
const UNLIKE_OTHERS: [&str; 3] = ["a_full_disk", "a_read_only_folder", "a_run_killed_at_any_change"];

/// Sources of figures.
pub enum Source {
    /// Tests of a binary whose names contain `filter`; they write their cases.
    Tests { binary: &'static str, filter: &'static str, when: When },
    /// The same tests, but for those whose names contain one of `skipped`; each module is a case.
    Modules { binary: &'static str, filter: &'static str, skipped: &'static [&'static str], when: When },
    /// `mbint verify` of the shipped models.
    VerifiedModels,
    /// `mbint run` of the shipped models, on other threads and processors.
    SameBytes,
    /// Other programs that are installed.
    Peers,
}

/// Runs that measure a source.
#[derive(Clone, Copy, PartialEq)]
pub enum When {
    Always,
    /// Replaces the source of a whole run.
    Quick,
    Whole,
    /// A whole run, if `MBINT_REFERENCE` names the folder of third-party results.
    WithReference,
}

use When::{Always, Quick, Whole, WithReference};

const CODE: &str = "code verification";
const SOLUTION: &str = "solution verification";
const VALIDATION: &str = "validation";
const QUALITY: &str = "software quality assurance";

const fn tests(binary: &'static str, filter: &'static str, when: When) -> Source {
    Source::Tests { binary, filter, when }
}

/// Index of the claim whose runs list missed bands, too.
pub const FALSIFIER: usize = 7;

pub const CLAIMS: [Claim; 13] = [
    Claim {
        name: "elements",
        title: "Every element is integrated with the order of theory",
        activity: CODE,
        claim: "With every effect and every joint of the language, errors fall with the step as theory tells, derivatives are exact and the power of all forces is balanced; beams and superelements \
                feel nothing of a constant velocity.",
        setup: "Each element stands with the example of its reference in a small mechanism, in the plane, in space or in both. A manufactured motion is exact because its \
                loads are added; steps are halved until orders settle, by HHT-I3, by HHT-I3 extrapolated over three levels and by Dormand and Prince's explicit method of order 8, in \
                absolute and in joint coordinates. Derivatives of all programs are compared with differences of 32 digits. Elastic parts are clamped to a carriage at 0 and at 20 m/s.",
        acceptance: "The lowest order of positions, velocities, accelerations, states and reactions is at least 1.9 (theory 2), 3.8 (4) and 4 (8, where rounding comes first); derivatives \
                     differ by at most 1e-9 of their row, the defect of power is at most 1e-9 of the powers, and inner forces change by at most 1e-8.",
        scope: "Smooth motions of the examples' parameters. [The table of all elements](../reference/verification.md) has every case. Elements whose examples have no smooth motion \
                are excepted; their own tests compare them with closed forms.",
        sources: &[tests("elements", "every_element_is_verified", Whole)],
        table: Table::Extremes,
    },
    Claim {
        name: "models",
        title: "Shipped models are integrated with the order of theory",
        activity: CODE,
        claim: "Every shipped model is integrated with the order of theory along a manufactured motion near its own.",
        setup: "`mbint verify MODEL --format json` of all files in `models/`, in every formulation that a model has.",
        acceptance: "As of the elements; the lowest order over quantities and formulations stands in the table, `exact` where steps of any length have rounding errors only.",
        scope: "Nominal parameters, a part of each run from its start and one behind an instant at which the equations switch. A model in which a formulation has no smooth part is excepted, with the \
                reason that the program tells.",
        sources: &[Source::VerifiedModels],
        table: Table::Cases,
    },
    Claim {
        name: "benchmarks",
        title: "Published benchmark problems are solved",
        activity: CODE,
        claim: "Solutions of published problems are those that other methods find, with second order in the step.",
        setup: "Problems of the IFToMM Library of Computational Benchmark Problems (A01 to A05), of the test set for solvers of initial value problems, a spinning top, and the slider crank of \
                Wu, Luo and Zhang. Reference solutions are of other formulations (minimal coordinates, index 1) and other integrators or series.",
        acceptance: "Order 2 to within 0.1 as steps are halved; the library's limits of energy; limits beside each error.",
        scope: "Largest errors over the whole benchmark, in m or rad as the benchmark observes it. How each reference was made is told in `tests/reference/README.md`.",
        sources: &[
            tests("models", "hard_cases::benchmarks::every_benchmark_converges_with_order_two", Whole),
            tests("models", "hard_cases::benchmarks::andrews_mechanism_is_exact_to_a_millionth", Always),
            tests("models", "hard_cases::benchmarks::energy_is_kept_as_the_benchmarks_ask", Whole),
            tests("models", "slider_crank::nominal_motion_extrapolates_to_the_references", Whole),
            tests("models", "slider_crank::chebyshev_bounds_are_the_true_range", Whole),
        ],
        table: Table::Cases,
    },
    Claim {
        name: "textbook",
        title: "Textbook linkages follow their closed forms",
        activity: CODE,
        claim: "Linkages move as trigonometry tells, to the tolerance of Newton's method.",
        setup: "Shipped models over their whole runs against closed forms.",
        acceptance: "Errors of positions are below 1e-10 (m or rad), in space below 1e-9; other limits stand beside their figures.",
        scope: "Few of the closed forms that the tests compare with; `tests/models/` and `tests/elements/` have the others.",
        sources: &[
            tests("models", "the_rocker_obeys_freudenstein", Always),
            tests("models", "the_quick_return_", Always),
            tests("models", "the_spatial_four_bar_closes_its_loop", Always),
            tests("models", "peaucelliers_pen_draws_a_straight_line", Always),
            tests("models", "the_pendulum_has_its_period", Always),
        ],
        table: Table::Cases,
    },
    Claim {
        name: "adams",
        title: "One body on each joint moves as in MSC Adams",
        activity: CODE,
        claim: "Positions, velocities, accelerations and reactions of a body on one joint or spring are those of MSC Adams.",
        setup: "m = 1 kg from rest under gravity, 5 s with steps of 1 ms, 501 rows, against Adams' results of 7 digits that Project Chrono publishes (BSD licence).",
        acceptance: "Largest differences: 1e-3 of positions, velocities and Euler parameters, 2e-2 of accelerations, 1e-3 N and 1 % of the largest force.",
        scope: "Adams' own errors are part of the differences. The results are not in the repository: a machine without their folder (`MBINT_REFERENCE`) does not measure this.",
        sources: &[tests("elements", "it_moves_as_in_adams", WithReference)],
        table: Table::Cases,
    },
    Claim {
        name: "peers",
        title: "Robots move as in other programs",
        activity: CODE,
        claim: "Robots that are read from MJCF and URDF move as in the programs that these formats are of.",
        setup: "Recorded motions of MuJoCo and of Pinocchio's algorithm over 1 s; mbint reads the same files. Last come the versions of peers that are installed here; MuJoCo computes recorded motions again \
                (`tests/reference/mjcf/motion.py`), and Exudyn the slider crank (`benches/peers/exudyn_peer.py`) and its mini examples (`tests/peers/in_exudyn.py`).",
        acceptance: "At most 1e-4 m or rad apart, with steps of 0.5 and 1 ms; order 2 where steps are halved. Peers compute their recorded motions again.",
        scope: "Without contacts, whose laws differ between programs. Pinocchio's motions are third-party results: they are measured where `MBINT_REFERENCE` names their folder. Times are \
                [another page](../performance/index.md).",
        sources: &[
            tests("models", "robots_move_as_in_mujoco", Always),
            tests("models", "a_crane_swings_as_by_recursive_newton_euler_dynamics", Always),
            tests("models", "robots_swing_as_those_of_pinocchio", WithReference),
            Source::Peers,
        ],
        table: Table::Cases,
    },
    Claim {
        name: "collections",
        title: "Test models of other programs have their values",
        activity: CODE,
        claim: "Mechanisms of the test collections of Exudyn and of Project Chrono, written for mbint, have the values that these programs compute, or that their tests state.",
        setup: "Mini examples of Exudyn, made again in Exudyn with steps so short that its values have converged (`tests/peers/in_exudyn.py`); unit tests of Chrono that state a closed form, or \
                equations in minimal coordinates (`tests/peers/closed_forms.py`). The models are `tests/peers/*/*.yaml`, the cases `tests/peers/*.csv`.",
        acceptance: "The largest difference as a share of the largest value; each case has its own limit, with the reason beside it.",
        scope: "Chosen because mbint has their elements: no shells, solids, fluids or terrain, and no contacts, whose laws differ. Values of Chrono's own integrators are compared where its tests \
                state them.",
        sources: &[tests("models", "peers::", Always)],
        table: Table::Cases,
    },
    Claim {
        name: "falsifier",
        title: "Stated errors of bounds hold",
        activity: SOLUTION,
        claim: "In rows without a flag, the least and the greatest value of an output over the box lie within the stated error of the band.",
        setup: "Models are drawn at random from families whose motion is known without the program, and every band is compared with the true range, row by row \
                ([how](../theory/falsification.md)). Draws are independent, bands of one draw are not: so the trial is the draw.",
        acceptance: "The interval of confidence of the share of draws with a missed band lies below 1 %, of all families together; of their rows without a flag at least 99 % are covered. Where the \
                     interval has 1 % in it, more draws have to decide.",
        scope: "Drawn families only; \"stated / true error\" is the geometric mean over bands. A missed band has more than 1 % of its rows beyond their errors. Draws that take over five minutes are not \
                judged, and count neither as covered nor as missed: by them the command has more draws than the table. Missed draws are listed among \
                [known misses](misses.md).",
        sources: &[
            tests("falsify", "errors_of_a_few_draws_are_honest", Quick),
            tests("falsify", "errors_are_honest", Whole),
        ],
        table: Table::Cases,
    },
    Claim {
        name: "questions",
        title: "Answers of other analyses hold",
        activity: SOLUTION,
        claim: "Stated shares that fail, allocated tolerances, bounds of many parameters and responses to excitations are true.",
        setup: "Drawn questions whose answers are known: normal and χ² tails, optima on parabolas, integrals of closed forms, sums over frequencies.",
        acceptance: "Shares: no more outside of intervals of 95 % than chance allows in one of a thousand runs; of the others, no more than `tests/falsify/known.rs` lists.",
        scope: "Counts of wrong answers; rows of one draw hang together, so that they have no interval of confidence.",
        sources: &[
            tests("falsify", "root_mean_squares_are_honest", Quick),
            tests("falsify", "shares_that_fail_are_honest", Whole),
            tests("falsify", "allocations_are_honest", Whole),
            tests("falsify", "ends_of_many_parameters_are_honest", Whole),
            tests("falsify", "ends_over_functions_are_honest", Whole),
            tests("falsify", "root_mean_squares_are_honest", Whole),
        ],
        table: Table::Cases,
    },
    Claim {
        name: "certified",
        title: "Certified bounds are proofs",
        activity: SOLUTION,
        claim: "Certified bands hold every solution; certificates are proven again by a second checker, and changed ones are refused.",
        setup: "Bands of `mbint run --certify` against solutions by DOP853 of equations derived by hand, and of drawn mechanisms; a certificate of which one line is changed at a time.",
        acceptance: "All solutions lie within; the band is hardly wider than they reach; every changed certificate is refused.",
        scope: "Smooth mechanisms of at most three uncertain parameters ([extent of a proof](../guides/certify.md)). Solutions are samples: they can refute a proof, not make one.",
        sources: &[
            tests("models", "certify_motion::solutions_of_the_slider_crank_are_held", Always),
            tests("models", "certify_motion::solutions_of_the_double_pendulum_are_held", Whole),
            tests("models", "certify_motion::thousands_of_solutions", Whole),
            tests("models", "certify_motion::the_whole_slider_crank_is_held", Whole),
            tests("falsify", "certified_bands_hold_the_truth", Whole),
            tests("program", "certificates_are_proven_again_and_changed_ones_are_refused", Always),
        ],
        table: Table::Cases,
    },
    Claim {
        name: "validation",
        title: "Wings bend and vibrate as measured",
        activity: VALIDATION,
        claim: "Models of two wings that bend far have the measured values, but for errors of the model that are stated here.",
        setup: "The Pazy wing without skin, loaded at its tip (Avin et al., AIAA J. 60, 2022; stiffnesses of Riso and Cesnik), and Tang and Dowell's wing, which sags under its own weight (AIAA J. 39, \
                2001; numbers and points of figures by AeroBeams). Bounds of `tests/validation/*.yaml` over intervals of the inputs. By ASME V&V 20, E = S − D of a simulated and a measured value has \
                the uncertainty u_val² = u_num² + u_input² + u_D²; the model's own error is E ± u_val.",
        acceptance: "The comparison error is at most 8 % of the Pazy wing's displacements, 12 % of frequencies and 4 % of the small chordwise displacement; UM/NAST's values with the same stiffnesses \
                     are met to 0.1 %.",
        scope: "Where |E| exceeds u_val the model disagrees with the measurement: the Pazy wing is measured softer than the finite-element model of its stiffnesses, and Tang and Dowell's wing stiffer \
                flapwise than its stiffness and masses as they were read have it; its authors' own theory has 2.47 Hz and a tip of 55.3 mm at 0°, so that these numbers may not be all of their wing. The sources that were read state no uncertainties: u_D is the scatter about a smooth \
                curve and the digits of a reading, and the intervals of the inputs are assumptions, named in each model. Both are statics and small vibrations; no machine in motion is \
                validated yet.",
        sources: &[
            tests("models", "validation::the_pazy_wing_bends_as_measured", Quick),
            tests("models", "validation::", Whole),
        ],
        table: Table::Cases,
    },
    Claim {
        name: "bytes",
        title: "Results are the same bytes",
        activity: QUALITY,
        claim: "Results do not depend on the number of threads, nor on whether the processor fuses a multiplication with an addition or has wide registers.",
        setup: "Every shipped model is run three times: as it is; on one thread; and with a C library that does not use FMA, AVX2 and AVX-512.",
        acceptance: "No file of the results differs in a byte.",
        scope: "One machine. Other systems and processors (Linux, macOS and Windows, x86-64 and ARM64) are compared by the snapshots of the project's continuous integration, and are not measured here.",
        sources: &[Source::SameBytes],
        table: Table::Extremes,
    },
    Claim {
        name: "robustness",
        title: "Any input is answered by a result or a message",
        activity: QUALITY,
        claim: "Whatever stands in a file, the answer is a result or an error; what goes wrong around a run leaves nothing half.",
        setup: "Models, robots and formulas changed at random, of a fixed seed; then faults: full disks, signals, kills, panics, numbers beyond all limits, names with control characters.",
        acceptance: "No input panics, hangs or takes 1 GB; every fault ends as its test asks.",
        scope: "Mutations of the shipped models and of the bad models of the tests; fuzzing guided by coverage (`fuzz/`) is run by hand and not counted.",
        sources: &[
            tests("fuzz", "few::formulas", Quick),
            tests("fuzz", "many::", Whole),
            Source::Modules { binary: "program", filter: "faults::names", skipped: &[], when: Quick },
            Source::Modules { binary: "program", filter: "faults::", skipped: &UNLIKE_OTHERS, when: Whole },
            tests("program", "a_run_killed_at_any_change_of_its_folder_leaves_no_mixture", Whole),
        ],
        table: Table::Cases,
    },
];

impl When {
    pub fn is_of(self, quick: bool) -> bool {
        match self {
            Always => true,
            Quick => quick,
            Whole | WithReference => !quick,
        }
    }
}
