//! Arguments shared by several commands.

use std::path::PathBuf;

use clap::Args;

use super::{methods, parse_override};
use crate::cli::Failure;
use crate::cli::load::Given;
use crate::cli::tuning::TUNING;
use crate::methods::Proof;
use crate::model::{Override, read_overlay};
use crate::results::Method;
use crate::syntax::{Coded, Diagnostics};

/// Number of computing threads.
#[derive(Clone, Copy, Debug, Args)]
pub(in crate::cli) struct Threads {
    /// Number of threads; results do not depend on it [default: one per core].
    #[arg(short = 'j', long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=TUNING.most_threads))]
    threads: Option<u16>,
}

impl Threads {
    /// `None` for one per core.
    pub fn number(self) -> Option<usize> {
        self.threads.map(usize::from)
    }
}

/// Scene of one model, and settings of its simulation.
#[derive(Debug, Args)]
pub(in crate::cli) struct OneRunArgs {
    /// Use this scene of the model.
    #[arg(long, value_name = "NAME")]
    pub scene: Option<String>,

    #[command(flatten)]
    pub threads: Threads,

    /// Print nothing but errors.
    #[arg(short, long)]
    pub quiet: bool,
}

/// Questions to a model.
#[derive(Debug, Args)]
pub(in crate::cli) struct AskedArgs {
    /// Methods to run: chebyshev, taylor, scan, certified [default: the model's].
    #[arg(short, long, value_name = "METHOD", value_delimiter = ',')]
    #[arg(value_parser = methods(), hide_possible_values = true)]
    pub method: Vec<Method>,

    /// Add certified bounds: proven for all parameter values within their tolerances, for the true motion, or for the
    /// motion as the time steps define it (`--certify=scheme`).
    #[arg(long, value_name = "PROOF", num_args = 0..=1, require_equals = true, default_missing_value = "motion")]
    #[arg(value_parser = proof)]
    pub certify: Option<Proof>,

    #[command(flatten)]
    pub set: SetArgs,

    /// Run this scene only; may be given several times [default: all scenes].
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub scene: Vec<String>,

    /// Exclude parameter values with which the mechanism cannot be assembled or does not reach the end of the
    /// simulation; the column `covered` has the remaining share.
    #[arg(long)]
    pub skip_infeasible: bool,

    /// Also simulate every sample with halved steps, to estimate the time error of every bound [default: a few
    /// samples].
    #[arg(long)]
    pub certify_time: bool,
}

impl AskedArgs {
    /// Methods and scenes in a fixed order, each once.
    pub fn in_order(mut self) -> Self {
        self.method.sort_unstable();
        self.method.dedup();
        self.scene.sort_unstable();
        self.scene.dedup();
        self
    }
}

/// A proof, by its name.
fn proof(name: &str) -> Result<Proof, String> {
    match name {
        "motion" => Ok(Proof::Motion),
        "scheme" => Ok(Proof::Scheme),
        _ => Err("there are `motion` and `scheme`".to_owned()),
    }
}

/// Files that models may name.
#[derive(Debug, Args)]
pub(in crate::cli) struct RootArgs {
    /// Let models also name files of this folder or below: tables, robots, meshes, included files [default: only of the
    /// model's folder].
    #[arg(long, value_name = "DIR")]
    pub root: Option<PathBuf>,
}

/// Parameters set on the command line, and the folder of models' files.
#[derive(Debug, Args)]
pub(in crate::cli) struct SetArgs {
    /// Set a parameter, such as `l1=0.16`, `l1=0.16±2%` or `l1=[0.15, 0.17]`; may be given several times.
    #[arg(short, long, value_name = "NAME=VALUE", value_parser = parse_override)]
    set: Vec<Override>,

    /// Set the parameters of this YAML file (`parameters: { l1: 0.16 ± 2% }`), as written by `mbint allocate`; `--set`
    /// takes precedence.
    #[arg(long, value_name = "FILE")]
    with: Vec<PathBuf>,

    #[command(flatten)]
    files: RootArgs,
}

impl SetArgs {
    /// Settings of models; every parameter is set at most once.
    ///
    /// # Errors
    /// For the first parameter that is set twice, and for errors of a file.
    pub fn given(&self) -> Result<Given, Failure> {
        Ok(Given { overrides: overlaid(&self.with, &self.set)?, root: self.files.root.clone(), witness: None })
    }
}

/// Parameters set by files and by `--set`; the latter take precedence.
///
/// # Errors
/// For the first parameter that is set twice, and for errors of a file.
pub(in crate::cli) fn overlaid(with: &[PathBuf], set: &[Override]) -> Result<Vec<Override>, Failure> {
    let mut laid: Vec<Override> = Vec::new();
    for path in with {
        let wrong = |wrong: Diagnostics| {
            // The terminal output adds the first `error[CODE]: ` itself.
            let text = wrong.to_string();
            let head = wrong.code().map_or_else(String::new, |code| format!("error[{code}]: "));
            Failure::wrong(text.strip_prefix(&head).unwrap_or(&text).trim_end()).of(&wrong)
        };
        laid.extend(read_overlay(path).map_err(wrong)?);
    }
    for all in [&laid[..], set] {
        let twice = |&(i, setting): &(usize, &Override)| all[..i].iter().any(|earlier| earlier.name == setting.name);
        if let Some((_, setting)) = all.iter().enumerate().find(twice) {
            return Err(Failure::wrong(format!("parameter `{}` is set twice", setting.name)));
        }
    }
    laid.retain(|own| set.iter().all(|setting| setting.name != own.name));
    laid.extend(set.iter().cloned());
    Ok(laid)
}
