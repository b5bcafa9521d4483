//! `mbint plan`, `shard`, `status` and `merge`: a study on many machines that share a folder.

mod sampling;
mod submit;

use std::fmt::Write;
use std::path::{Path, PathBuf};

pub(super) use self::submit::submit;
use super::args::{AskedArgs, MergeArgs, PlanArgs, ShardArgs, StatusArgs, Threads};
use super::console::{Console, count};
use super::kept_run::{KeptRun, context};
use super::load::Given;
use super::request::{Request, Settings};
use super::run::run_all;
use super::sample::target;
use super::{Failure, Status, load};
use crate::methods::{Certified, Method, Proof};
use crate::model::Override;
use crate::store::{Missing, PartStore, Plan, Shard, StoreError, StudyFolder, StudyRequest};
use crate::study;

fn failed(error: &StoreError) -> Failure {
    Failure::failed(error).of(error)
}

/// `mbint plan`: lists the simulations, and cuts them into shards.
pub(super) fn plan(args: PlanArgs, console: &mut Console) -> Result<Status, Failure> {
    let folder = StudyFolder::new(&args.output);
    let points = sampling::asked(&args.points)?;
    let mut models = Vec::new();
    let AskedArgs { method, certify, set, scene, skip_infeasible, certify_time } = args.asked.in_order();
    for model in &args.models {
        if crate::model::is_standard_input(model) {
            return Err(Failure::wrong("a study needs its models as files: shards read them again"));
        }
        models.push(absolute(model)?);
    }
    let said = set.given()?;
    let asked = StudyRequest {
        models,
        named: args.models,
        set: said.overrides.iter().map(|setting| setting.text.clone()).collect(),
        root: said.root.map(|root| absolute(&root)).transpose()?,
        scenes: scene,
        methods: method.iter().map(|method| method.name().to_owned()).collect(),
        certify: certify.is_some(),
        certify_scheme: certify == Some(Proof::Scheme),
        certify_time,
        skip_infeasible,
        at_once: args.at_once,
        shard_seconds: args.shard_seconds,
        points,
    };
    let kept = KeptRun::of_study(args.output.clone(), &asked).planning();
    let (status, shards) = if asked.points.is_some() {
        let status = sampling::simulate(&asked, &kept, None, args.threads, true, console)?;
        (status, kept.shards())
    } else {
        let request = request(&asked, args.threads, kept)?;
        let status = run_all(&request, console, &mut |_, _, _| ())?;
        (status, request.store.map(KeptRun::shards).unwrap_or_default())
    };
    if status > Status::Deferred {
        return Ok(status);
    }
    let text = overview(&shards);
    folder.write(1, asked, shards).map_err(|error| failed(&error))?;
    console.print(&format!("{text}in {}\n", args.output.display()))?;
    Ok(Status::Done)
}

/// `mbint merge`: makes the results, or the next round's plan.
pub(super) fn merge(args: MergeArgs, console: &mut Console) -> Result<Status, Failure> {
    let folder = StudyFolder::new(&args.study);
    let plan = folder.plan().map_err(|error| failed(&error))?;
    let missing = folder.missing(&plan).map_err(|error| failed(&error))?;
    if !missing.is_empty() {
        let shards = ranges(&missing);
        return Err(Failure::failed(format!("{}: shards {shards} are missing; run them first", args.study.display())));
    }
    let kept = KeptRun::of_study(args.study.clone(), &plan.asked);
    let (status, shards) = if plan.asked.points.is_some() {
        let target = target(args.output, None);
        let status = sampling::simulate(&plan.asked, &kept, Some(target), args.threads, args.quiet, console)?;
        (status, kept.shards())
    } else {
        let mut request = request(&plan.asked, args.threads, kept)?;
        request.output = args.output;
        request.quiet = args.quiet;
        let status = run_all(&request, console, &mut |_, _, _| ())?;
        (status, request.store.map(KeptRun::shards).unwrap_or_default())
    };
    if status == Status::Deferred {
        let text = overview(&shards);
        folder.write(plan.round + 1, plan.asked, shards).map_err(|error| failed(&error))?;
        console.print(&format!("another round: {text}in {}\n", args.study.display()))?;
    }
    Ok(status)
}

/// `mbint shard`: simulates the missing parts of one shard.
pub(super) fn shard(args: &ShardArgs, console: &mut Console) -> Result<Status, Failure> {
    let folder = StudyFolder::new(&args.study);
    let Plan { asked, shards, .. } = folder.plan().map_err(|error| failed(&error))?;
    let Some(shard) = shards.get(args.index) else {
        let last = shards.len().checked_sub(1).map_or_else(|| "none".to_owned(), |last| format!("0 to {last}"));
        return Err(Failure::wrong(format!("there is no shard {}; there are: {last}", args.index)));
    };
    let given = given(&asked)?;
    let path = asked.models.get(shard.model).ok_or_else(|| failed(&StoreError::damaged(folder.path())))?;
    let scenes: Vec<String> = shard.scene.iter().cloned().collect();
    let Some(loaded) = load::load_all(std::slice::from_ref(path), &given, &scenes, console)? else {
        return Ok(Status::Wrong);
    };
    let Some((model, (_, mut description))) =
        loaded.models.into_iter().next().and_then(|mut model| model.scenes.pop().map(|scene| (model.files, scene)))
    else {
        return Ok(Status::Failed);
    };
    if let Some(proof) = proof(&asked) {
        description.bounds.certified = Some(Certified { proof });
    }
    let context = context(&model, &asked.set, shard.scene.as_deref(), asked.skip_infeasible);
    let store = PartStore::open(folder.path(), &context, Missing::Simulate).map_err(|error| failed(&error))?;
    let options = study::Options {
        // Samples need no method.
        methods: if asked.points.is_some() { Some(Vec::new()) } else { methods(&asked)? },
        threads: args.threads.number(),
        skip_infeasible: asked.skip_infeasible,
        store: Some(&store),
        interrupted: &super::interrupt::asked,
        ..study::Options::default()
    };
    let name = &description.name;
    study::simulate_parts(&description, &options, &store, &shard.parts)
        .map_err(|error| Failure::failed(format!("{name}: {error}")).of(&error))?;
    if super::interrupt::asked() { Ok(Status::Interrupted) } else { Ok(Status::Done) }
}

/// `mbint status`: the missing parts of a plan.
pub(super) fn status(args: &StatusArgs, console: &mut Console) -> Result<Status, Failure> {
    let folder = StudyFolder::new(&args.study);
    let plan = folder.plan().map_err(|error| failed(&error))?;
    let missing = folder.missing(&plan).map_err(|error| failed(&error))?;
    let numbers = ranges(&missing);
    if args.missing {
        console.print(&format!("{numbers}\n"))?;
    } else if missing.is_empty() {
        let all = count(plan.shards.len(), "shard", "shards");
        console.print(&format!("round {}: all of {all} are there; next: mbint merge\n", plan.round))?;
    } else {
        let left: Vec<Shard> = missing.iter().map(|&number| plan.shards[number].clone()).collect();
        let all = plan.shards.len();
        console.print(&format!(
            "round {}: of {all} shards, {numbers} are missing\n{}to go\n",
            plan.round,
            overview(&left)
        ))?;
    }
    Ok(if missing.is_empty() { Status::Done } else { Status::Deferred })
}

/// The corresponding request of `mbint run`.
fn request(asked: &StudyRequest, threads: Threads, kept: KeptRun) -> Result<Request, Failure> {
    Ok(Request {
        witness: None,
        models: asked.models.clone(),
        named: asked.named.clone(),
        given: given(asked)?,
        scenes: asked.scenes.clone(),
        certify: proof(asked),
        output: None,
        quiet: true,
        report: true,
        junit: None,
        timings: false,
        overwrite: false,
        settings: Settings {
            methods: methods(asked)?,
            threads: threads.number(),
            yes: true,
            certify_time: asked.certify_time,
            skip_infeasible: asked.skip_infeasible,
            derivatives: true,
            quiet: true,
            profile: None,
        },
        store: Some(kept),
    })
}

/// Claim of certified bounds, if they are requested.
fn proof(asked: &StudyRequest) -> Option<Proof> {
    asked.certify.then_some(if asked.certify_scheme { Proof::Scheme } else { Proof::Motion })
}

fn methods(asked: &StudyRequest) -> Result<Option<Vec<Method>>, Failure> {
    let method = |name: &String| {
        let known = Method::ALL.into_iter().find(|method| method.name() == name);
        known.ok_or_else(|| Failure::failed(format!("there is no method `{name}`")))
    };
    let methods = asked.methods.iter().map(method).collect::<Result<Vec<_>, _>>()?;
    Ok((!methods.is_empty()).then_some(methods))
}

fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    std::path::absolute(path).map_err(|error| Failure::wrong(format!("{}: {error}", path.display())))
}

fn given(asked: &StudyRequest) -> Result<Given, Failure> {
    let parse = |text: &String| Override::parse(text).map_err(|_| Failure::failed(format!("`{text}` cannot be read")));
    Ok(Given {
        overrides: asked.set.iter().map(parse).collect::<Result<_, _>>()?,
        root: asked.root.clone(),
        witness: None,
    })
}

/// Number of shards, their time on one core, and their size on the disk.
fn overview(shards: &[Shard]) -> String {
    let simulations: usize = shards.iter().map(|shard| shard.simulations).sum();
    let seconds = shards.iter().fold(0.0, |sum, shard| sum + shard.seconds);
    let bytes: u64 = shards.iter().map(|shard| shard.bytes).sum();
    let mut text = format!("{}, {simulations} simulations", count(shards.len(), "shard", "shards"));
    let _ = write!(text, ", at least {seconds:.0} s on one core, {} on the disk ", indicatif::HumanBytes(bytes));
    text
}

/// Numbers as `3,7-9`.
fn ranges(numbers: &[usize]) -> String {
    let consecutive = numbers.chunk_by(|a, b| a + 1 == *b);
    let range = |range: &[usize]| match range {
        [first, .., last] => format!("{first}-{last}"),
        [only] => only.to_string(),
        [] => String::new(),
    };
    consecutive.map(range).collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::ranges;

    #[test]
    fn consecutive_numbers_are_ranges() {
        assert_eq!(ranges(&[3, 7, 8, 9, 11, 12]), "3,7-9,11-12");
        assert_eq!(ranges(&[]), "");
    }
}
