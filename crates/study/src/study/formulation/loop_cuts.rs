//! Choice of the joints that close the loops of a mechanism in joint coordinates: those with which its steps are
//! shortest.
//!
//! The number of instructions depends on the cut by a half and more, and is known only when a cut is compiled. From the
//! cut of the shallowest trees one exchange after the other is compiled, and adopted if it is shorter, until none is,
//! or the budget is used up.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::candidates::Compiled;
use super::comparison::{instructions, starts_alike};
use super::enough;
use crate::assemble::{self, Questions, System};
use crate::simulate::Simulator;
use crate::study::formulation::tuning::TUNING;

/// One with another cut than the first, and a shorter step that starts alike, if there is one; `with_roots`, also one
/// in which bodies behind joints of several axes have coordinates of their own. `assemble` makes the equations of
/// questions that give the cut. They are not compiled if they are longer than those of the best so far, nor to the
/// end if that takes many times its operations. Redundant constraints and a singular start depend on the cut, and
/// are left with the first.
pub fn shortest(
    questions: &Questions,
    first: &Simulator,
    with_roots: bool,
    assemble: impl Fn(&Questions) -> Option<System> + Sync,
) -> Option<Simulator> {
    let is_regular = |simulator: &Simulator| {
        simulator.mobility.redundant.is_empty() && simulator.mobility.singular_at_start.is_empty()
    };
    if !is_regular(first) {
        return None;
    }
    let mut shorter: Option<Simulator> = None;
    let mut tried = BTreeSet::from([first.system.formulation.cut.clone()]);
    let mut spent = 0;
    'exchanges: loop {
        let best = shorter.as_ref().unwrap_or(first);
        let (least, length) = (instructions(best), best.system.length() as f64);
        let current = questions.cut_at(best.system.formulation.cut.clone());
        let roots = if with_roots { assemble::cuts_of_several_axes(&current) } else { Vec::new() };
        let cuts = assemble::other_cuts(&current).into_iter().chain(roots).filter(|cut| !tried.contains(cut));
        // Cuts after a shorter one are compiled for nothing, and not counted.
        let at_once = rayon::current_num_threads().min(TUNING.cuts_at_once);
        for cuts in cuts.collect::<Vec<_>>().chunks(at_once) {
            let others = cuts.par_iter().map(|cut| {
                let system = assemble(&questions.cut_at(cut.clone()))?;
                if system.length() as f64 > TUNING.longer_equations * length {
                    return None;
                }
                Compiled::within(system, questions.description, enough(best)).ok()
            });
            for (cut, other) in cuts.iter().zip(others.collect::<Vec<_>>()) {
                if spent + least > TUNING.cut_instructions {
                    return shorter;
                }
                if !tried.insert(cut.clone()) {
                    continue;
                }
                spent += other.as_ref().map_or(least, instructions);
                let is_shorter = |other: &Simulator| instructions(other) < least && is_regular(other);
                if let Some(other) = other.filter(|other| is_shorter(other) && starts_alike(best, other)) {
                    shorter = Some(other);
                    continue 'exchanges;
                }
            }
        }
        return shorter;
    }
}
