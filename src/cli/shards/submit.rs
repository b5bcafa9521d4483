//! `mbint submit`: a study's shards as a job array of Slurm, and its merging as the job after it.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::cli::args::SubmitArgs;
use crate::cli::console::{Console, count};
use crate::cli::tuning::TUNING;
use crate::cli::{Failure, Status};
use crate::store::StudyFolder;
use crate::syntax::is_harmful;

/// Writes the scripts of a round into the study's folder, and submits them.
pub(in crate::cli) fn submit(args: &SubmitArgs, console: &mut Console) -> Result<Status, Failure> {
    let failed = |message: String| Failure::failed(message);
    let folder =
        std::path::absolute(&args.study).map_err(|error| failed(format!("{}: {error}", args.study.display())))?;
    let output = args.output.as_ref().map(std::path::absolute).transpose();
    let output = output.map_err(|error| failed(error.to_string()))?;
    [Some(&folder), output.as_ref()].into_iter().flatten().try_for_each(|path| takes(path)).map_err(Failure::wrong)?;
    let program = std::env::current_exe().map_err(|error| failed(format!("where this program is: {error}")))?;
    let study = StudyFolder::new(&folder);
    let plan = study.plan().map_err(|error| failed(error.to_string()))?;
    let missing = study.missing(&plan).map_err(|error| failed(error.to_string()))?;
    let job = Job { program, folder, output, options: &args.options, round: plan.round };
    let array = if missing.is_empty() { None } else { Some(job.submit_array(&missing).map_err(failed)?) };
    let merge = job.submit_merge(array.as_deref()).map_err(failed)?;
    let shards = array.map(|array| format!("{} as job {array}, then ", count(missing.len(), "shard", "shards")));
    console.print(&format!(
        "{}merging as job {merge}; scripts in {}\n",
        shards.unwrap_or_default(),
        job.folder.display()
    ))?;
    Ok(Status::Done)
}

/// Common parts of the scripts of a round.
struct Job<'a> {
    program: PathBuf,
    folder: PathBuf,
    output: Option<PathBuf>,
    /// Options of `sbatch`.
    options: &'a [String],
    round: usize,
}

impl Job<'_> {
    /// Submits the shards as an array; each of its n tasks simulates every n-th one.
    fn submit_array(&self, missing: &[usize]) -> Result<String, String> {
        let tasks = missing.len().min(TUNING.most_tasks);
        let list = self.write("shards", &missing.iter().map(|number| format!("{number}\n")).collect::<String>())?;
        let (program, folder) = (quoted(&self.program), quoted(&self.folder));
        let mut script = head("shards");
        let _ = write!(
            script,
            "#SBATCH --array=0-{last}\n\
             #SBATCH --requeue\n\n\
             # Task t takes every {tasks}th line of the list, from the t-th on. What is there already is skipped.\n\
             for shard in $(awk -v t=\"$SLURM_ARRAY_TASK_ID\" 'NR % {tasks} == (t + 1) % {tasks}' {list}); do\n  \
               if ! {program} shard {folder} --index \"$shard\" --threads \"${{SLURM_CPUS_PER_TASK:-1}}\"; then\n    \
                 # The task goes into the queue again.\n    \
                 if [ \"${{SLURM_RESTART_COUNT:-0}}\" -lt {requeues} ]; then\n      \
                   scontrol requeue \"${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}\"\n    \
                 fi\n    \
                 exit 1\n  \
               fi\n\
             done\n",
            last = tasks - 1,
            requeues = TUNING.most_requeues,
            list = quoted(&list),
        );
        self.sbatch("array.sh", "shards-%A_%a", &script, None)
    }

    /// Submits merging, to run when all tasks of the array have ended; it submits the next round if there is one.
    fn submit_merge(&self, array: Option<&str>) -> Result<String, String> {
        let (program, folder) = (quoted(&self.program), quoted(&self.folder));
        let output = self.output.as_ref().map_or_else(String::new, |output| format!(" --output {}", quoted(output)));
        let options: String = self.options.iter().map(|option| format!(" {}", quoted(Path::new(option)))).collect();
        let options = if options.is_empty() { options } else { format!(" --{options}") };
        let mut script = head("merge");
        let _ = write!(
            script,
            "\n{program} merge {folder}{output} --threads \"${{SLURM_CPUS_PER_TASK:-1}}\"\n\
             status=$?\n\
             # 75: the study goes on with another round.\n\
             if [ $status -eq 75 ]; then exec {program} submit {folder} --slurm{output}{options}; fi\n\
             exit $status\n"
        );
        self.sbatch("merge.sh", "merge-%j", &script, array)
    }

    fn write(&self, name: &str, text: &str) -> Result<PathBuf, String> {
        let path = self.folder.join(format!("round-{}-{name}", self.round));
        let logs = self.folder.join("logs");
        let written = std::fs::create_dir_all(&logs).and_then(|()| std::fs::write(&path, text));
        written.map(|()| path.clone()).map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Submits a script of this name, with its log. Directives in the script would need a quoting of their own.
    fn sbatch(&self, name: &str, log: &str, script: &str, after: Option<&str>) -> Result<String, String> {
        let path = self.write(name, script)?;
        // Slurm replaces `%A` by numbers; `%%` is the sign itself.
        let folder = self.folder.join("logs").to_string_lossy().replace('%', "%%");
        let mut command = Command::new("sbatch");
        command
            .arg("--parsable")
            .arg(format!("--output={folder}/round-{}-{log}.log", self.round))
            .args(after.map(|job| format!("--dependency=afterany:{job}")))
            .args(self.options)
            .arg(&path);
        let done = command.output().map_err(|error| format!("`sbatch` cannot be run: {error}"))?;
        let said = |bytes: &[u8]| String::from_utf8_lossy(bytes).trim().to_owned();
        if !done.status.success() {
            return Err(format!("`sbatch` refused {}: {}", path.display(), said(&done.stderr)));
        }
        // The cluster's name follows a semicolon.
        Ok(said(&done.stdout).split(';').next().unwrap_or_default().to_owned())
    }
}

/// The first lines of a script.
fn head(what: &str) -> String {
    format!("#!/bin/bash\n#SBATCH --job-name=mbint-{what}\n#SBATCH --open-mode=append\n")
}

/// An error if Slurm cannot take a path unchanged.
fn takes(path: &Path) -> Result<(), String> {
    let refused = path.to_str().is_none_or(|path| path.chars().any(|c| is_harmful(c) || "\n\t\\".contains(c)));
    if refused {
        let name = path.display();
        return Err(format!(
            "{name}: Slurm does not take a path with a control character, a backslash or bytes that are not UTF-8: \
             rename the folder"
        ));
    }
    Ok(())
}

/// A path as one word of a shell.
fn quoted(path: &Path) -> String {
    let text = path.to_string_lossy();
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-=+,:@%".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        text.into_owned()
    } else {
        format!("'{}'", text.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_quoted_for_a_shell() {
        assert_eq!(quoted(Path::new("/a/b-1.yaml")), "/a/b-1.yaml");
        assert_eq!(quoted(Path::new("it's $HOME")), r"'it'\''s $HOME'");
        assert_eq!(quoted(Path::new("")), "''");
    }
}
