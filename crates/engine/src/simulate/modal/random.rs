//! Responses of outputs of a linearised mechanism to stationary random excitations.
//!
//! ```text
//! y(iω) = H(iω) x(iω),   H = C (K + iω C − ω² M)⁻¹ B + D,   B = B₀ + iω B₁ − ω² B₂ by x, ẋ and ẍ
//! σ² = ∫ |H|² G dν,   σ̇² = ∫ ω² |H|² G dν,   ω = 2π v ν
//! ```
//!
//! over the band of each density G. Excitations that follow one another add up with their delays, others by their
//! squares. σ̇/(2π σ) is the frequency with which an output rises through its mean (S. O. Rice, Bell Syst. Tech. J. 24
//! (1945) 46).

use std::f64::consts::TAU;

use rustc_hash::FxHashMap;
use symdiff::{Expr, Graph, math};

use super::response::{Load, Response};
use super::tuning::TUNING;
use crate::assemble::{RandomInput, System};
use crate::compile::{Layout, equations_of_motion};
use crate::numerics::{Spectrum, integrals};

/// Random excitations of a mechanism, and derivatives of its equations by them.
#[derive(Clone, Debug)]
pub struct RandomLoads {
    graph: Graph,
    /// Symbols in the expressions, with their registers in the layout.
    symbols: Vec<(Expr, usize)>,
    inputs: Vec<RandomInput>,
    /// Derivatives by each symbol of an input: of rows of the equations of motion, and of outputs.
    motion: Vec<(usize, usize, Expr)>,
    outputs: Vec<(usize, usize, Expr)>,
    sizes: [usize; 2],
}

/// An excitation at a sample.
struct Random<'l> {
    seed: &'l str,
    level: f64,
    speed: f64,
    delay: f64,
    spectrum: &'l Spectrum,
    band: [f64; 2],
    /// −B₀, −B₁ and −B₂: n entries each.
    forces: [Vec<f64>; 3],
    /// D₀, D₁ and D₂: one of each output.
    direct: [Vec<f64>; 3],
}

impl RandomLoads {
    /// Differentiates a system and its first outputs; `None` without random excitations.
    pub fn new(system: &System, outputs: usize) -> Option<Self> {
        if system.random.is_empty() {
            return None;
        }
        let mut graph = system.graph.clone();
        graph.limit(None);
        let (motion, _) = equations_of_motion(system, &mut graph);
        let observed: Vec<Expr> = system.outputs[..outputs].iter().map(|output| output.expr).collect();
        let by: Vec<Expr> = system.input_symbols().collect();
        let motion_by = graph.jacobian(&motion, &by).entries().collect();
        let outputs_by = graph.jacobian(&observed, &by).entries().collect();
        let layout = Layout::of(system);
        let parameters: Vec<Expr> = system.parameters.iter().map(|parameter| parameter.symbol).collect();
        let lists = [&parameters, &by, &system.q, &system.v, &system.w, &system.lambda];
        let registers =
            [&layout.parameters, &layout.inputs, &layout.q, &layout.v, &layout.w, &layout.lambda].map(Clone::clone);
        let mut symbols: Vec<(Expr, usize)> = lists
            .into_iter()
            .zip(registers)
            .flat_map(|(list, registers)| list.iter().copied().zip(registers))
            .collect();
        symbols.push((system.time, layout.time));
        let sizes = [system.q.len(), outputs];
        Some(Self { graph, symbols, inputs: system.random.clone(), motion: motion_by, outputs: outputs_by, sizes })
    }

    /// Root mean square of each output, and the frequency, Hz, with which it rises through its mean. `state` are the
    /// layout's registers, `by` derivatives of the outputs by q, v, w and λ, and `frequencies` those of the modes, Hz.
    pub fn tell(
        &self,
        state: &[f64],
        scale: &[f64],
        response: &Response,
        by: &[Vec<Vec<f64>>; 4],
        frequencies: &[f64],
    ) -> Vec<[f64; 2]> {
        let all = self.at(state, scale);
        let outputs = self.sizes[1];
        let mut squares = Some(vec![0.0; 2 * outputs]);
        let mut seeds: Vec<&str> = all.iter().map(|own| own.seed).collect();
        seeds.sort_unstable();
        seeds.dedup();
        for seed in seeds {
            let together: Vec<&Random> = all.iter().filter(|own| own.seed == seed).collect();
            let found = self.squares(&together, response, by, frequencies);
            squares = squares.zip(found).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a + b).collect());
        }
        let of_output = |output: usize| match &squares {
            Some(squares) => {
                let [deviation, rate] = [squares[2 * output].sqrt(), squares[2 * output + 1].sqrt()];
                [deviation, if deviation > 0.0 { rate / (TAU * deviation) } else { 0.0 }]
            }
            None => [f64::NAN; 2],
        };
        (0..outputs).map(of_output).collect()
    }

    /// σ² and σ̇² of each output under excitations that follow one another.
    fn squares(
        &self,
        together: &[&Random],
        response: &Response,
        by: &[Vec<Vec<f64>>; 4],
        frequencies: &[f64],
    ) -> Option<Vec<f64>> {
        let first = together.first()?;
        let outputs = self.sizes[1];
        let [from, to] = first.band;
        let begin = from.max(TUNING.least_frequency * to);
        let count = (TUNING.parts_of_band * math::log10(to / begin)).ceil().max(1.0);
        let even = (0..=count as usize).map(|part| begin * math::pow(to / begin, part as f64 / count));
        let kinks = first.spectrum.breaks().into_iter().chain(frequencies.iter().map(|own| own / first.speed));
        let mut breaks: Vec<f64> = even.chain(kinks).filter(|own| from < *own && *own < to).chain([from, to]).collect();
        breaks.sort_unstable_by(f64::total_cmp);
        breaks.dedup();
        integrals(&breaks, 2 * outputs, TUNING.accuracy_of_squares, |frequency, values| {
            let omega = TAU * first.speed * frequency;
            let density = first.level * first.spectrum.density(frequency);
            let mut load = Load::nothing(self.sizes[0]);
            let mut direct = vec![[0.0; 2]; outputs];
            for own in together {
                let turned = math::sin_cos(-omega * own.delay);
                own.add(omega, (turned.1, turned.0), &mut load, &mut direct);
            }
            let motion = response.to(&load, omega);
            for (output, [re, im]) in direct.into_iter().enumerate() {
                let rows = [0, 1, 2, 3].map(|kind| by[kind][output].as_slice());
                let moved = motion.as_ref().map_or([f64::NAN; 2], |motion| response.output(motion, &load, rows, omega));
                let [re, im] = [re + moved[0], im + moved[1]];
                let power = density * (re * re + im * im);
                (values[2 * output], values[2 * output + 1]) = (power, omega * omega * power);
            }
        })
    }

    /// The excitations at a state.
    fn at(&self, state: &[f64], scale: &[f64]) -> Vec<Random<'_>> {
        let values: FxHashMap<Expr, f64> =
            self.symbols.iter().map(|&(symbol, register)| (symbol, state[register])).collect();
        let entries = self.motion.iter().chain(&self.outputs).map(|&(_, _, value)| value);
        let of_inputs = self.inputs.iter().flat_map(|input| [input.level, input.speed, input.delay]);
        let roots: Vec<Expr> = entries.chain(of_inputs).collect();
        let numbers = self.graph.evaluate(&roots, |symbol| values.get(&symbol).copied().unwrap_or(f64::NAN));
        let (by_motion, rest) = numbers.split_at(self.motion.len());
        let (by_outputs, of_inputs) = rest.split_at(self.outputs.len());
        let mut all: Vec<Random> = Vec::with_capacity(self.inputs.len());
        for (input, numbers) in self.inputs.iter().zip(of_inputs.chunks_exact(3)) {
            all.push(Random {
                seed: &input.seed,
                level: numbers[0],
                speed: numbers[1],
                delay: numbers[2],
                spectrum: &input.spectrum,
                band: input.band,
                forces: std::array::from_fn(|_| vec![0.0; self.sizes[0]]),
                direct: std::array::from_fn(|_| vec![0.0; self.sizes[1]]),
            });
        }
        for (&(row, column, _), value) in self.motion.iter().zip(by_motion) {
            all[column / 3].forces[column % 3][row] = -value * scale[row];
        }
        for (&(row, column, _), value) in self.outputs.iter().zip(by_outputs) {
            all[column / 3].direct[column % 3][row] = *value;
        }
        all
    }
}

impl Random<'_> {
    /// Adds a unit of it at ω, turned by a phase (real and imaginary part).
    fn add(&self, omega: f64, phase: (f64, f64), load: &mut Load, direct: &mut [[f64; 2]]) {
        let of = |parts: &[Vec<f64>; 3], index: usize| {
            let (re, im) = (parts[0][index] - omega * omega * parts[2][index], omega * parts[1][index]);
            [re * phase.0 - im * phase.1, re * phase.1 + im * phase.0]
        };
        for index in 0..load.re.len() {
            let [re, im] = of(&self.forces, index);
            load.re[index] += re;
            load.im[index] += im;
        }
        for (index, sum) in direct.iter_mut().enumerate() {
            let [re, im] = of(&self.direct, index);
            *sum = [sum[0] + re, sum[1] + im];
        }
    }
}
