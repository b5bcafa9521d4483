//! A process of the program, with threads that write to it and read from it, so that nothing waits for ever.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::trouble::Words;
use super::tuning::TUNING;

/// Output of a process.
pub(super) enum Said {
    /// A line, without its end.
    Line(String),
    /// More than it may in a call.
    TooMuch,
    /// Its output ended.
    End,
    /// Nothing until the time was over.
    Nothing,
    /// The run is to end.
    Interrupted,
}

/// A process of the program.
#[derive(Debug)]
pub(super) struct Process {
    child: Child,
    /// `None` once its input has ended.
    input: Option<Sender<String>>,
    output: Receiver<Option<String>>,
    /// Bytes that it may yet write.
    left: Arc<AtomicU64>,
    words: Arc<Mutex<VecDeque<u8>>>,
}

impl Process {
    /// Starts a program.
    ///
    /// # Errors
    /// If it cannot be started.
    pub fn start(mut command: Command) -> std::io::Result<Self> {
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        // An interruption of the terminal is for mbint, which ends its processes itself.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn()?;
        let missing = || std::io::Error::other("a pipe is missing");
        let stdin = child.stdin.take().ok_or_else(missing)?;
        let stdout = child.stdout.take().ok_or_else(missing)?;
        let stderr = child.stderr.take().ok_or_else(missing)?;
        let (input, texts) = channel::<String>();
        let (lines, output) = channel();
        let (left, words) = (Arc::new(AtomicU64::new(0)), Arc::new(Mutex::new(VecDeque::new())));
        thread::spawn(move || write(stdin, &texts));
        let (allowed, heard) = (left.clone(), words.clone());
        thread::spawn(move || read(stdout, &allowed, &lines));
        thread::spawn(move || listen(stderr, &heard));
        Ok(Self { child, input: Some(input), output, left, words })
    }

    /// Gives it a text; `most` bytes may come back. With `ends`, it gets no more.
    pub fn give(&mut self, text: String, most: u64, ends: bool) {
        self.left.store(most, Ordering::Relaxed);
        // A process that has ended is found where its answers are read.
        let _ = self.input.as_ref().map(|input| input.send(text));
        if ends {
            self.input = None;
        }
    }

    /// Returns its next line, or the reason why none has come.
    pub fn next(&self, until: Option<Instant>, interrupted: &dyn Fn() -> bool) -> Said {
        loop {
            let rest =
                until.map_or(TUNING.glance, |until| until.saturating_duration_since(Instant::now()).min(TUNING.glance));
            match self.output.recv_timeout(rest) {
                Ok(Some(line)) => return Said::Line(line),
                Ok(None) => return Said::TooMuch,
                Err(RecvTimeoutError::Disconnected) => return Said::End,
                Err(RecvTimeoutError::Timeout) if interrupted() => return Said::Interrupted,
                Err(RecvTimeoutError::Timeout) if until.is_some_and(|until| Instant::now() >= until) => {
                    return Said::Nothing;
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
    }

    /// Ends it: its input, then itself if it goes on. Returns how it ended.
    pub fn end(&mut self, grace: bool) -> String {
        self.input = None;
        let until = Instant::now() + if grace { TUNING.grace } else { Duration::ZERO };
        let mut pause = Duration::from_micros(200);
        loop {
            match self.child.try_wait() {
                Ok(Some(status)) => return status.to_string(),
                Ok(None) if Instant::now() < until => {
                    thread::sleep(pause);
                    pause = (2 * pause).min(TUNING.glance);
                }
                _ => break,
            }
        }
        // If it cannot be ended, it has ended already.
        let _ = self.child.kill();
        self.child.wait().map_or_else(|error| error.to_string(), |status| status.to_string())
    }

    /// Its last words on standard error.
    pub fn words(&self) -> Words {
        let mut words = self.words.lock().unwrap_or_else(PoisonError::into_inner);
        Words(String::from_utf8_lossy(words.make_contiguous()).into_owned())
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.end(true);
    }
}

/// Writes texts until there are no more, which ends the input.
fn write(mut stdin: impl Write, texts: &Receiver<String>) {
    for text in texts {
        // A process that reads no more is found by the end of its output.
        if stdin.write_all(text.as_bytes()).and_then(|()| stdin.flush()).is_err() {
            return;
        }
    }
}

/// Reads lines as long as they are allowed; `None` if they are too long or too many. The limit is read when
/// something has come: before, the call may not have begun.
fn read(stdout: impl Read, allowed: &AtomicU64, lines: &Sender<Option<String>>) {
    let mut stdout = BufReader::new(stdout);
    let mut line: Vec<u8> = Vec::new();
    loop {
        let come = match stdout.fill_buf() {
            Ok(come) if !come.is_empty() => come,
            _ => break,
        };
        let end = come.iter().position(|&byte| byte == b'\n').map(|end| end + 1);
        let taken = end.unwrap_or(come.len());
        line.extend_from_slice(&come[..taken]);
        stdout.consume(taken);
        let (left, length) = (allowed.load(Ordering::Relaxed), line.len() as u64);
        if length > left {
            // The receiver learns of the excess; without a receiver, nothing is lost.
            let _ = lines.send(None);
            return;
        }
        if end.is_some() {
            allowed.store(left - length, Ordering::Relaxed);
            if lines.send(Some(text(&line))).is_err() {
                return;
            }
            line.clear();
        }
    }
    if !line.is_empty() {
        let _ = lines.send(Some(text(&line)));
    }
}

/// A line without its end.
fn text(line: &[u8]) -> String {
    String::from_utf8_lossy(line).trim_end_matches(['\n', '\r']).to_owned()
}

/// Stores the end of the standard error.
fn listen(mut stderr: impl Read, words: &Mutex<VecDeque<u8>>) {
    let mut buffer = [0; 1024];
    while let Ok(read @ 1..) = stderr.read(&mut buffer) {
        let mut words = words.lock().unwrap_or_else(PoisonError::into_inner);
        words.extend(&buffer[..read]);
        let beyond = words.len().saturating_sub(TUNING.words_bytes);
        words.drain(..beyond);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pipe whose bytes come one by one, after the limit of the call is known.
    struct Slow<'s>(&'s [u8], &'s AtomicU64);

    impl Read for Slow<'_> {
        fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
            self.1.fetch_max(100, Ordering::Relaxed);
            let Some((first, rest)) = self.0.split_first() else { return Ok(0) };
            into[0] = *first;
            self.0 = rest;
            Ok(1)
        }
    }

    #[test]
    fn lines_arrive_whole_at_any_pace() {
        let (lines, found) = channel();
        // Nothing is allowed while the reader waits for the first byte.
        let allowed = AtomicU64::new(0);
        read(Slow(b"{\"point\": 0}\r\nlast", &allowed), &allowed, &lines);
        drop(lines);
        let found: Vec<Option<String>> = found.iter().collect();
        assert_eq!(found, [Some("{\"point\": 0}".to_owned()), Some("last".to_owned())]);
    }

    #[test]
    fn excessive_output_is_truncated() {
        let (lines, found) = channel();
        let allowed = AtomicU64::new(10);
        read(&b"12345\n123456789"[..], &allowed, &lines);
        drop(lines);
        assert_eq!(found.iter().collect::<Vec<_>>(), [Some("12345".to_owned()), None]);
    }
}
