//! A draw with a miss is made simpler for as long as it has one.

use std::time::{Duration, Instant};

use crate::draw::{Bounds, Combine, Draw, Wrap};
use crate::random::digits;
use crate::verdict::{Outcome, Verdict, examine};

/// Time limit for shrinking a draw.
const PATIENCE: Duration = Duration::from_secs(15);

/// The simplest draw that was found, and its miss.
pub fn shrink(draw: &Draw, verdict: &Verdict) -> (Draw, Verdict) {
    let begun = Instant::now();
    let mut best = (only(draw, verdict), verdict.clone());
    // The miss must stay about as bad.
    let enough = (0.5 * badness(verdict)).min(10.0);
    match missed(&best.0) {
        Some(verdict) => best.1 = verdict,
        None => return (draw.clone(), verdict.clone()),
    }
    'simpler: loop {
        for candidate in simpler(&best.0, &best.1) {
            if begun.elapsed() > PATIENCE {
                return best;
            }
            if let Some(verdict) = missed(&candidate).filter(|verdict| badness(verdict) >= enough) {
                best = (candidate, verdict);
                continue 'simpler;
            }
        }
        return best;
    }
}

/// The draw with the output and the method of a verdict alone.
fn only(draw: &Draw, verdict: &Verdict) -> Draw {
    let mut draw = draw.clone();
    draw.outputs = vec![draw.outputs[verdict.output].clone()];
    let all = draw.bounds;
    let is = |method: &str| verdict.method.name() == method;
    draw.bounds = Bounds {
        chebyshev: all.chebyshev.filter(|_| is("chebyshev")),
        taylor: all.taylor.filter(|_| is("taylor")),
        scan: all.scan.filter(|_| is("scan")),
        ..all
    };
    draw
}

/// Largest ratio of true to stated error.
fn badness(verdict: &Verdict) -> f64 {
    verdict.worst().map_or(0.0, |miss| miss.off / miss.stated)
}

fn missed(draw: &Draw) -> Option<Verdict> {
    match examine(draw) {
        Outcome::Judged(verdicts, _) => verdicts.into_iter().find(Verdict::is_missed),
        _ => None,
    }
}

/// Draws that are simpler by one thing, those first that take away most.
fn simpler(draw: &Draw, verdict: &Verdict) -> Vec<Draw> {
    let mut all = Vec::new();
    let mut push = |change: &dyn Fn(&mut Draw) -> bool| {
        let mut changed = draw.clone();
        if change(&mut changed) {
            all.push(changed);
        }
    };
    for term in 0..draw.terms.len() {
        push(&|draw| without_term(draw, term));
    }
    push(&|draw| std::mem::replace(&mut draw.outputs[0].wrap, Wrap::Nothing) != Wrap::Nothing);
    push(&|draw| std::mem::replace(&mut draw.outputs[0].combine, Combine::Sum) != Combine::Sum);
    let last = verdict.misses.iter().map(|miss| miss.row).max().unwrap_or(draw.time.rows);
    for rows in [draw.time.rows / 2, last, draw.time.rows - 1] {
        push(&|draw| std::mem::replace(&mut draw.time.rows, rows.max(5)) > rows.max(5));
    }
    for (term, parameter) in
        draw.terms.iter().enumerate().flat_map(|(t, term)| (0..term.parameters.len()).map(move |p| (t, p)))
    {
        push(&|draw| {
            let many = draw.uncertain_count() > 1;
            many && std::mem::take(&mut draw.terms[term].parameters[parameter].half) != 0.0
        });
        push(&|draw| {
            let parameter = &mut draw.terms[term].parameters[parameter];
            parameter.half == 0.0 && parameter.removable && std::mem::take(&mut parameter.value) != 0.0
        });
        for few in [1, 2] {
            push(&|draw| rounded(&mut draw.terms[term].parameters[parameter], few));
        }
    }
    push(&|draw| lowered(&mut draw.bounds));
    push(&|draw| std::mem::take(&mut draw.bounds.expand_output));
    all
}

fn without_term(draw: &mut Draw, term: usize) -> bool {
    let inputs = &mut draw.outputs[0].inputs;
    let many = draw.terms.len() > 1 && inputs.len() > 1;
    if many {
        inputs.retain(|input| input.0 != term);
        inputs.iter_mut().filter(|input| input.0 > term).for_each(|input| input.0 -= 1);
        draw.terms.remove(term);
    }
    many && draw.uncertain_count() > 0
}

/// A value, and half its interval, of few digits.
fn rounded(parameter: &mut crate::draw::Parameter, few: usize) -> bool {
    let (value, half) = (digits(parameter.value, few), digits(parameter.half, few));
    let changed = parameter.most > 0.0 && (value != parameter.value || half != parameter.half);
    (parameter.value, parameter.half) = (value, half);
    changed
}

/// A lower order.
fn lowered(bounds: &mut Bounds) -> bool {
    let lower = |order: &mut Option<usize>, least: usize| match order {
        Some(order) if *order > least => {
            *order -= (*order - least).div_ceil(3);
            true
        }
        _ => false,
    };
    lower(&mut bounds.chebyshev, 1) | lower(&mut bounds.taylor, 1) | lower(&mut bounds.scan, 3)
}
