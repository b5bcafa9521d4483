//! The surrogate over the widest box that has one.

use super::items::{Item, items, with_tolerances};
use super::surface::Surface;
use super::tuning::TUNING;
use super::{AllocateError, AllocateOptions};
use crate::methods::{Chebyshev, Degree, Keep, Method};
use crate::model::Description;
use crate::results::Summary;
use crate::study::{Kept, Options, RunError, statistics, subsystems};

/// A surrogate over the widest box.
pub struct Wide {
    pub kept: Kept,
    pub items: Vec<Item>,
    pub simulations: usize,
}

/// The surrogate over the widest box that has one.
pub fn surrogate(model: &Description, asked: AllocateOptions, options: &Options) -> Result<Wide, AllocateError> {
    let mut widest = asked.widest;
    let mut simulations = 0;
    let mut narrower = 0;
    loop {
        let items = items(model, widest);
        let reach =
            |item: &Item| item.widest * if asked.share.is_some() { statistics::reach(model, &item.name) } else { 1.0 };
        let multiples: Vec<f64> = items.iter().map(reach).collect();
        let mut wide = with_tolerances(model, &items, &multiples);
        (options.stage)("the surrogate over the widest tolerances");
        for order in 0..=TUNING.raised_orders {
            let only = Options { methods: Some(vec![Method::Chebyshev]), ..of(options) };
            let ran = subsystems::run(&wide, &only, Keep::Margins);
            let failure = match ran {
                Ok((_, summary, kept)) => {
                    simulations += run_simulations(&summary);
                    match kept.filter(|kept| is_known(&items, kept)) {
                        Some(kept)
                            if order == TUNING.raised_orders || !is_rough(&items, &kept) || !raise(&mut wide) =>
                        {
                            return Ok(Wide { kept, items, simulations });
                        }
                        Some(_) => continue,
                        None if raise(&mut wide) && order < TUNING.raised_orders => continue,
                        None => None,
                    }
                }
                Err(error @ (RunError::Infeasible(_) | RunError::Simulation(_))) => Some(error),
                Err(error) => return Err(error.into()),
            };
            if narrower == TUNING.narrower_boxes {
                let unknown = "there is no reliable surrogate of the margins: bound the model with `mbint run` first";
                return Err(failure.map_or_else(|| AllocateError::Unsuitable(unknown.to_owned()), AllocateError::Run));
            }
            break;
        }
        narrower += 1;
        widest = 1.0 + 0.5 * (widest - 1.0);
    }
}

/// The same options for a run inside.
pub fn of<'a>(options: &Options<'a>) -> Options<'a> {
    Options { methods: None, store: None, ..*options }
}

pub fn run_simulations(summary: &Summary) -> usize {
    summary.methods.iter().map(|method| method.simulations).sum()
}

/// Whether every margin has a surrogate that can be relied on.
fn is_known(items: &[Item], kept: &Kept) -> bool {
    let Some(margins) = kept.margins() else { return false };
    let surface = Surface::new(margins, items);
    (0..surface.count).all(|index| surface.error(index).is_finite() && surface.nominal[index].is_finite())
}

/// Whether a higher order is worth it.
fn is_rough(items: &[Item], kept: &Kept) -> bool {
    let Some(margins) = kept.margins() else { return true };
    let surface = Surface::new(margins, items);
    (0..surface.count).any(|index| surface.surrogate_error(index) > TUNING.rough * surface.scale(index))
}

/// The largest error of a margin, as a share of the nominal one.
pub fn largest_error(surface: &Surface) -> f64 {
    (0..surface.count).map(|index| surface.error(index) / surface.scale(index)).fold(0.0, f64::max)
}

/// Raises the order, if it is given and the budget allows it.
pub fn raise(model: &mut Description) -> bool {
    let budget = model.bounds.budget.simulations as f64;
    let Some(Chebyshev { degree: Degree::Fixed { order, nodes }, .. }) = &mut model.bounds.chebyshev else {
        return false;
    };
    if nodes.iter().map(|nodes| (nodes + 2) as f64).product::<f64>() > budget {
        return false;
    }
    order.iter_mut().chain(nodes).for_each(|count| *count += 2);
    true
}
