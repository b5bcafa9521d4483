//! Switches that some parameter values meet and no sample does: a post that only some throws hit, a stop that only the
//! fastest reach.
//!
//! The motions of samples at Chebyshev nodes are polynomials in the parameters, row by row, and cubics in time between
//! rows. Over both the values of the switches are ranged: where one can change its sign and no sample's does, that
//! point is simulated itself. If it does switch, results from the samples are not valid from there on. With many
//! parameters only samples spread over the box are examined.
//!
//! The same samples show from when on steps have switches inside them.

use symdiff::Tile;

use super::control::Steps;
use super::drive::{Integrator, Observed};
use super::ensemble::EnsembleRun;
use super::error::SimulationError;
use super::interruption::Interruption;
use super::simulator::Simulator;
use super::step::Counters;
use super::tuning::TUNING;
use crate::compile::{SwitchProgram, Tapes};
use crate::numerics::{
    Extent, Lattices, ParameterBox, PointSet, SparseWork, Surrogate, SurrogateWork, extremes, spread,
};

/// Distances by which a switch went below and above zero since the row before.
type Depths = [f64; 2];

/// A point where a switch may have a sign that no sample's has.
#[derive(Clone, Debug)]
struct Suspect {
    row: usize,
    switch: usize,
    side: usize,
    /// Distance beyond zero.
    beyond: f64,
    xi: Vec<f64>,
}

/// Known behaviour of the switches in a box.
#[derive(Clone, Copy, Debug, Default)]
pub struct SwitchSearch {
    /// The first row before which a switch changes its sign for some parameter values and for none of the held-out
    /// samples.
    pub unmet_from: Option<usize>,
    /// The first row before which one changes its sign for any.
    pub switched_from: Option<usize>,
    /// Simulations that it took.
    pub simulations: usize,
    /// Work of these.
    pub counters: Counters,
}

/// Searches a box for switches that other samples than those `held_out` meet. `None` where there is no switch or
/// nothing uncertain.
///
/// # Errors
/// Where a sample cannot be assembled.
pub fn unmet_switch(
    simulator: &Simulator,
    domain: &ParameterBox,
    steps: Steps<'_>,
    held_out: &[Vec<f64>],
    interruption: Interruption<'_>,
) -> Result<Option<SwitchSearch>, SimulationError> {
    let k = domain.dimension();
    let Some(program) = simulator.switches().filter(|_| k > 0) else { return Ok(None) };
    let surrogate =
        TUNING.switch_degrees.get(k - 1).map(|&degree| Surrogate::tensor(&vec![degree; k], &vec![degree + 1; k]));
    let others = surrogate
        .as_ref()
        .map_or_else(|| spread(k, TUNING.switch_samples * k), |surrogate| surrogate.samples().to_vec());
    let nodes = others.len();
    let points = [&others, held_out].concat();
    let observing = Observing { simulator, program, domain, steps, interruption };
    let mut suspects = Vec::new();
    let mut before: Option<Vec<f64>> = None;
    let mut work = SurrogateWork::default();
    let between = surrogate.as_ref().map(|surrogate| Between { simulator, program, domain, surrogate });
    let Observations { depths, switched_from, mut counters } = observing.run(&points, nodes, |row, motions, met| {
        let Some(between) = &between else { return };
        let of_nodes: Vec<f64> = motions.chunks_exact(points.len()).flat_map(|line| line[..nodes].to_vec()).collect();
        let coefficients = between.surrogate.coefficients(&of_nodes, &mut work);
        if let Some(before) = before.replace(coefficients.clone()) {
            let times = [steps.schedule.time(row - 1), steps.schedule.time(row)];
            suspects.extend(between.suspects(row, times, [&before, &coefficients], &one_sided(program, met)));
        }
    })?;
    let reach = TUNING.switch_rows.max(depths.len() / TUNING.switch_share_of_rows);
    let is_met = |row: usize, switch: usize, side: usize, depth: f64| {
        let rows = row.saturating_sub(reach)..(row + reach + 1).min(depths.len());
        depths[rows]
            .iter()
            .any(|[_, held_out]| held_out[switch][side] > 0.0 && TUNING.as_deep * held_out[switch][side] >= depth)
    };
    let first_unmet = |of_samples: &[[Vec<Depths>; 2]]| {
        let unmet = |row: usize, depths: &[Depths]| {
            let is_unmet = |switch: usize, side: usize| {
                depths[switch][side] > 0.0 && !is_met(row, switch, side, depths[switch][side])
            };
            (0..depths.len()).any(|switch| (0..2).any(|side| is_unmet(switch, side)))
        };
        of_samples.iter().take(depths.len()).enumerate().position(|(row, [of_samples, _])| unmet(row, of_samples))
    };
    let by_nodes = first_unmet(&depths);
    suspects.retain(|suspect| !is_met(suspect.row, suspect.switch, suspect.side, suspect.beyond));
    let chosen = chosen(suspects, program.switches.len());
    let mut by_suspects = None;
    if !chosen.is_empty() {
        let found = observing.run(&chosen, chosen.len(), |_, _, _| ())?;
        by_suspects = first_unmet(&found.depths);
        counters += found.counters;
    }
    Ok(Some(SwitchSearch {
        unmet_from: by_nodes.into_iter().chain(by_suspects).min(),
        switched_from,
        simulations: points.len() + chosen.len(),
        counters,
    }))
}

/// The first row before which a switch changes its sign within a step of the nominal motion.
///
/// # Errors
/// Where the motion cannot be assembled.
pub fn switched_from(
    simulator: &Simulator,
    domain: &ParameterBox,
    steps: Steps<'_>,
    interruption: Interruption<'_>,
) -> Result<Option<usize>, SimulationError> {
    let Some(program) = simulator.switches() else { return Ok(None) };
    let observing = Observing { simulator, program, domain, steps, interruption };
    Ok(observing.run(&[vec![0.0; domain.dimension()]], 1, |_, _, _| ())?.switched_from)
}

/// Switches whose rates are known and that had one sign only, or the other one by little, with that other one: 0 below
/// zero, 1 above.
fn one_sided(program: &SwitchProgram, met: &[Depths]) -> Vec<(usize, usize)> {
    let other = |(switch, met): (usize, &Depths)| {
        let side = usize::from(met[0] > met[1]);
        let is_one_sided = met[side] < TUNING.shallow_switch * met[1 - side];
        (program.switches[switch].rate.is_some() && is_one_sided).then_some((switch, side))
    };
    met.iter().enumerate().filter_map(other).collect()
}

/// ξ of the suspects that are worth a simulation.
fn chosen(suspects: Vec<Suspect>, switches: usize) -> Vec<Vec<f64>> {
    let mut chosen: Vec<Vec<f64>> = Vec::new();
    for (switch, side) in (0..switches).flat_map(|switch| [(switch, 0), (switch, 1)]) {
        let mut own: Vec<&Suspect> =
            suspects.iter().filter(|suspect| (suspect.switch, suspect.side) == (switch, side)).collect();
        let mut places: Vec<&Vec<f64>> = own.iter().take(TUNING.most_first).map(|suspect| &suspect.xi).collect();
        own.sort_by(|a, b| b.beyond.total_cmp(&a.beyond).then(a.row.cmp(&b.row)));
        places.extend(own.iter().take(TUNING.most_furthest).map(|suspect| &suspect.xi));
        places.into_iter().for_each(|xi| {
            if !chosen.contains(xi) {
                chosen.push(xi.clone());
            }
        });
    }
    chosen
}

/// Values seen in samples.
struct Observations {
    /// Depths of switches before each row, of the first samples and of the others.
    depths: Vec<[Vec<Depths>; 2]>,
    /// The first row before which one of them switched.
    switched_from: Option<usize>,
    counters: Counters,
}

/// Simulation of samples.
struct Observing<'a> {
    simulator: &'a Simulator,
    program: &'a SwitchProgram,
    domain: &'a ParameterBox,
    steps: Steps<'a>,
    interruption: Interruption<'a>,
}

impl Observing<'_> {
    /// Simulates samples as far as all of them get; `look` is given each row, the motions (2n lines) there, and how far
    /// switches went since the row before. The first `split` samples are kept apart from the others.
    fn run(
        &self,
        xi: &[Vec<f64>],
        split: usize,
        mut look: impl FnMut(usize, &[f64], &[Depths]),
    ) -> Result<Observations, SimulationError> {
        let samples = self.domain.samples(xi);
        let mut run = EnsembleRun::start(self.simulator, &samples, self.steps.schedule.first_step())?;
        run.heed(self.interruption);
        let (lines, switches) = (2 * self.simulator.program.scale.len(), self.program.switches.len());
        let stride = (lines + 2 * switches) * samples.len();
        let mut sizes = vec![0.0_f64; switches];
        let (mut all, mut values): (Vec<[Vec<Depths>; 2]>, Vec<f64>) = (Vec::new(), Vec::new());
        let mut switched_from = None;
        for first in (0..self.steps.schedule.rows).step_by(TUNING.switch_block) {
            let rows = first..(first + TUNING.switch_block).min(self.steps.schedule.rows);
            let stops = run.advance(self.steps, rows.clone(), Observed::Switches, &mut values);
            if run.is_cut() {
                break;
            }
            let reached = stops.iter().map(|stop| stop.row).min().unwrap_or(rows.end);
            for (row, values) in (rows.start..reached).zip(values.chunks_exact(stride)) {
                let (motions, extents) = values.split_at(lines * samples.len());
                let switches = extents.chunks_exact(2 * samples.len());
                let finite = |value: &&f64| value.is_finite();
                for (size, extents) in sizes.iter_mut().zip(switches.clone()) {
                    *size = extents.iter().filter(finite).fold(*size, |size, value| size.max(value.abs()));
                }
                let [mut before, mut after] = [Vec::new(), Vec::new()];
                for (size, extents) in sizes.iter().zip(switches) {
                    let (low, high) = extents.split_at(samples.len());
                    let has_switched = |(low, high): (&f64, &f64)| {
                        *low < -TUNING.switch_zero * size && *high > TUNING.switch_zero * size && high.is_finite()
                    };
                    if switched_from.is_none() && low.iter().zip(high).any(has_switched) {
                        switched_from = Some(row);
                    }
                    before.push(depths(&low[..split], &high[..split], TUNING.switch_zero * size));
                    after.push(depths(&low[split..], &high[split..], TUNING.switch_zero * size));
                }
                let deeper = |(a, b): (&Depths, &Depths)| [a[0].max(b[0]), a[1].max(b[1])];
                look(row, motions, &before.iter().zip(&after).map(deeper).collect::<Vec<Depths>>());
                all.push([before, after]);
            }
            if reached < rows.end {
                break;
            }
        }
        Ok(Observations { depths: all, switched_from, counters: run.counters() })
    }
}

/// Depths of least and largest values; less than `zero` is nothing. Values are infinite before the first step.
fn depths(low: &[f64], high: &[f64], zero: f64) -> Depths {
    let deepest = |values: &mut dyn Iterator<Item = f64>| {
        values.filter(|value| *value > zero && value.is_finite()).fold(0.0, f64::max)
    };
    [deepest(&mut low.iter().map(|&low| -low)), deepest(&mut high.iter().copied())]
}

/// The values of switches between two rows, over the box.
struct Between<'a> {
    simulator: &'a Simulator,
    program: &'a SwitchProgram,
    domain: &'a ParameterBox,
    surrogate: &'a Surrogate,
}

impl Between<'_> {
    /// Points where switches, each with a side of zero, may lie on that side between the row before and this one, given
    /// the motions' coefficients in both.
    fn suspects(
        &self,
        row: usize,
        times: [f64; 2],
        motions: [&[f64]; 2],
        one_sided: &[(usize, usize)],
    ) -> Vec<Suspect> {
        let k = self.domain.dimension();
        let switches: Vec<usize> = one_sided.iter().map(|&(switch, _)| switch).collect();
        let mut intervals = vec![TUNING.switch_intervals[k.min(TUNING.switch_intervals.len()) - 1]; k];
        intervals.push(TUNING.intervals_of_time);
        if switches.is_empty() {
            return Vec::new();
        }
        let lattice = lattice(&intervals);
        let values = self.values(&lattice, times, motions, &switches);
        let near = |(index, line): (usize, &[f64])| {
            let (low, high) = line.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
            let (distance, size) = if one_sided[index].1 == 0 { (low, high) } else { (-high, -low) };
            (distance <= TUNING.switch_near * (high - low) && size > 0.0).then_some((index, size))
        };
        let near: Vec<(usize, f64)> = values.chunks_exact(lattice.len()).enumerate().filter_map(near).collect();
        if near.is_empty() {
            return Vec::new();
        }
        let closer: Vec<usize> = near.iter().map(|&(index, _)| switches[index]).collect();
        let least: Vec<f64> = near.iter().map(|(_, size)| TUNING.switch_zero * size).collect();
        let found =
            extremes(&Lattices::default(), &intervals, &least, &|points| self.values(points, times, motions, &closer));
        let suspect = |(&(index, size), found): (&(usize, f64), &Extent)| {
            let (switch, side) = one_sided[index];
            let beyond = if side == 0 { -found.range.lower } else { found.range.upper };
            (beyond > TUNING.switch_zero * size).then(|| Suspect {
                row,
                switch,
                side,
                beyond,
                xi: found.places[side][..k].to_vec(),
            })
        };
        near.iter().zip(&found).filter_map(suspect).collect()
    }

    /// Values of switches, one after the other, at (ξ, time between the rows in −1 … 1).
    fn values(&self, points: &[Vec<f64>], times: [f64; 2], motions: [&[f64]; 2], switches: &[usize]) -> Vec<f64> {
        let (n, k) = (self.simulator.program.scale.len(), self.domain.dimension());
        let mut at_rows = [vec![0.0; 2 * n * points.len()], vec![0.0; 2 * n * points.len()]];
        let xi = PointSet::of(points);
        for (at_row, motion) in at_rows.iter_mut().zip(motions) {
            self.surrogate.basis().values(xi.points(), motion, at_row, &mut SparseWork::default());
        }
        let layout = &self.program.layout;
        let mut tile = Tile::new(TUNING.switch_width, self.program.registers(), self.program.constants());
        let h = times[1] - times[0];
        let mut values = vec![0.0; switches.len() * points.len()];
        for first in (0..points.len()).step_by(TUNING.switch_width) {
            let count = TUNING.switch_width.min(points.len() - first);
            for lane in 0..TUNING.switch_width {
                let point = first + lane.min(count - 1);
                let s = 0.5 * (1.0 + points[point][k]);
                for (parameter, &xi) in points[point][..k].iter().enumerate() {
                    tile.lane_mut(layout.parameters.start + parameter)[lane] = self.domain.value(parameter, xi);
                }
                for line in 0..n {
                    let of = |row: usize, line: usize| at_rows[row][line * points.len() + point];
                    let cubic = hermite([of(0, line), of(1, line)], [of(0, n + line), of(1, n + line)], h, s);
                    tile.lane_mut(layout.q.start + line)[lane] = cubic[0];
                    tile.lane_mut(layout.v.start + line)[lane] = cubic[1];
                }
                tile.lane_mut(layout.time)[lane] = times[0] + s * h;
            }
            tile.run(self.program.sample());
            tile.run(self.program.evaluate());
            for (index, &switch) in switches.iter().enumerate() {
                let register = self.program.switches[switch].value;
                let into = &mut values[index * points.len() + first..][..count];
                into.copy_from_slice(&tile.lane(register)[..count]);
            }
        }
        values
    }
}

/// Value and slope at the share s of a step of length h, of the cubic through values and slopes at its ends.
fn hermite([a, b]: [f64; 2], [slope_a, slope_b]: [f64; 2], h: f64, s: f64) -> [f64; 2] {
    let r = 1.0 - s;
    let value = r * r * ((1.0 + 2.0 * s) * a + s * h * slope_a) + s * s * ((3.0 - 2.0 * s) * b - r * h * slope_b);
    let slope = 6.0 * r * s * (b - a) / h + r * (1.0 - 3.0 * s) * slope_a + s * (3.0 * s - 2.0) * slope_b;
    [value, slope]
}

/// Equidistant points, both ends included.
fn lattice(intervals: &[usize]) -> Vec<Vec<f64>> {
    intervals.iter().fold(vec![Vec::new()], |points, &count| {
        let along = |point: Vec<f64>| {
            let coordinates = (0..=count).map(move |index| 2.0 * index as f64 / count as f64 - 1.0);
            coordinates.map(move |xi| [point.as_slice(), &[xi]].concat()).collect::<Vec<_>>()
        };
        points.into_iter().flat_map(along).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_interpolated_exactly() {
        let f = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t - 3.0 * t.powi(3);
        let slope = |t: f64| -2.0 + t - 9.0 * t * t;
        let [value, rate] = hermite([f(0.2), f(0.6)], [slope(0.2), slope(0.6)], 0.4, 0.3);
        assert!((value - f(0.32)).abs() < 1e-14 && (rate - slope(0.32)).abs() < 1e-13);
    }

    #[test]
    fn lattices_contain_both_ends() {
        let points = lattice(&[2, 4]);
        assert_eq!((points.len(), &points[0], &points[14]), (15, &vec![-1.0, -1.0], &vec![1.0, 1.0]));
    }
}
