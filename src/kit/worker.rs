//! The worker: a process that contains a kit and answers requests, one after the other, until the pipe
//! closes.
//!
//! Messages are bytes in the format of [`message`] after a length of four bytes. On Unix both directions use the socket that
//! the other side passes as standard input, so nothing that student code prints can get between two messages;
//! elsewhere requests come through standard input and replies leave through standard output.

use crate::kit::questions::{self, Question, Response};
use crate::kit::{Answer, KitError, Request, StudentKit, kit_error};
use crate::message;
use crate::message::{Message, from_bytes, to_bytes};
use crate::progress::{Tile, Watch};
use std::cell::RefCell;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::rc::Rc;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// A thread, by the folder in which Linux describes it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Thread(Option<PathBuf>);

impl Thread {
    /// The calling thread.
    pub fn current() -> Thread {
        let link = std::fs::read_link("/proc/thread-self").ok();
        Thread(link.map(|link| Path::new("/proc").join(link)))
    }

    /// The thread in this folder, such as `/proc/PID/task/TID`.
    pub fn at(folder: PathBuf) -> Thread {
        Thread(Some(folder))
    }

    /// The time for which the thread has been ready to compute but had no processor, because others used them. It is 0 after
    /// the end of the thread, and on other systems.
    pub fn waited(&self) -> Duration {
        self.schedstat(1).unwrap_or_default()
    }

    /// The time that the thread has spent on a processor, at its last switch: for a thread that computes, up to a tick of
    /// the kernel (4 ms) ago. `None` after the end of the thread, and on other systems.
    pub fn ran(&self) -> Option<Duration> {
        self.schedstat(0)
    }

    /// The exact time that the calling thread has spent on a processor. It sleeps for a moment, which is such a switch.
    pub fn processor_time() -> Option<Duration> {
        std::thread::sleep(Duration::from_nanos(1));
        Thread::current().ran()
    }

    fn schedstat(&self, place: usize) -> Option<Duration> {
        let text = std::fs::read_to_string(self.0.as_ref()?.join("schedstat")).ok()?;
        nanoseconds(&text, place)
    }
}

/// One of three numbers: nanoseconds on a processor, nanoseconds of waiting for one, and the number of turns.
fn nanoseconds(schedstat: &str, place: usize) -> Option<Duration> {
    Some(Duration::from_nanos(schedstat.split_whitespace().nth(place)?.parse().ok()?))
}

/// The longest message that [`receive`] accepts, in bytes (1 GiB).
pub const LONGEST_MESSAGE: usize = 1 << 30;

/// The stack of the thread that runs student code, in bytes (64 MiB): enough for a recursion of depth 100,000
/// at a few hundred bytes per call.
pub const STACK_BYTES: usize = 64 << 20;

/// A message from a worker: progress, a question, an answer, or the reason why there is no answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Reply {
    /// The progress of a frame; the answer follows later.
    Progress {
        /// The number of finished pixels.
        done: u64,
        /// The number of all pixels.
        total: u64,
    },
    /// The pixels of a finished tile, if the request asks for tiles.
    Tile(Tile),
    /// The progress of building the structure of a frame, before its first pixel.
    Building {
        /// The number of primitives that are in leaves.
        placed: u64,
        /// The number of all primitives.
        total: u64,
    },
    /// A question about a [withheld](Request::Withheld) request. The worker waits for a [`Response`].
    Question(Question),
    /// The answer to the request.
    Answer(Box<Answer>),
    /// The reason why there is no answer.
    KitError(KitError),
}

message! { enum Reply {
    Progress { done, total }, Tile(a), Building { placed, total }, Question(a), Answer(a), KitError(a)
} }

/// Writes one message to the pipe: four bytes of length, little-endian, then the message itself. Flushes the
/// pipe.
///
/// # Errors
///
/// If the message is longer than `u32::MAX` bytes, or if the pipe cannot be written.
pub fn send<T: Message>(pipe: &mut impl Write, message: &T) -> io::Result<()> {
    let bytes = to_bytes(message);
    let length = u32::try_from(bytes.len()).map_err(io::Error::other)?;
    pipe.write_all(&length.to_le_bytes())?;
    pipe.write_all(&bytes)?;
    pipe.flush()
}

/// Reads one message of at most [`LONGEST_MESSAGE`] bytes, and waits for it if necessary.
///
/// # Errors
///
/// - [`io::ErrorKind::UnexpectedEof`] if the other side has closed the pipe, between two messages or within
///   one.
/// - [`io::ErrorKind::Other`] if the message is too long or malformed.
/// - Any error of reading the pipe.
pub fn receive<T: Message>(pipe: &mut impl Read) -> io::Result<T> {
    receive_up_to(pipe, LONGEST_MESSAGE)
}

/// Reads one message of at most `longest` bytes, and waits for it if necessary. Memory grows with the bytes
/// that arrive, not with the announced length.
///
/// # Errors
///
/// The same as those of [`receive`].
pub fn receive_up_to<T: Message>(pipe: &mut impl Read, longest: usize) -> io::Result<T> {
    let mut length = [0; 4];
    pipe.read_exact(&mut length)?;
    let length = u32::from_le_bytes(length) as usize;
    if length > longest {
        return Err(io::Error::other(format!("a message of {length} bytes")));
    }
    // Let the buffer grow with the bytes that arrive, because the announced length may be wrong.
    let mut bytes = Vec::new();
    pipe.take(length as u64).read_to_end(&mut bytes)?;
    if bytes.len() < length {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    from_bytes(&bytes).map_err(|error| io::Error::other(format!("no message: {error}")))
}

/// Answers requests with the functions of a crate until the pipe closes: the complete `main` of a worker.
/// Other errors of the pipe are reported on standard error.
pub fn serve(functions: impl StudentKit) {
    let kit = functions.door();
    serve_with(&|request, watch| request.answer(&*kit, watch));
}

/// Answers requests with any function in place of a kit, until the pipe closes. A panic of `answer` is caught
/// and sent as [`Reply::KitError`].
pub fn serve_with(answer: &AnswerFunction<'_>) {
    end_with_parent();
    let work = || {
        let (reader, writer) = pipes()?;
        answer_all(answer, reader, writer)
    };
    let served = std::thread::scope(|scope| {
        let deep = std::thread::Builder::new().name("exercise".into()).stack_size(STACK_BYTES);
        match deep.spawn_scoped(scope, work) {
            Ok(thread) => thread.join().unwrap_or(Ok(())),
            // A sandbox allows no threads; its launcher has given this thread a deep stack.
            Err(_) => work(),
        }
    });
    if let Err(error) = served
        && error.kind() != io::ErrorKind::UnexpectedEof
    {
        eprintln!(
            "This is a worker: `raykata check --kit exercises` starts it and asks it questions. \
             It cannot be used by hand ({error})."
        );
    }
}

/// The number of the process that starts a [`child`].
const PARENT: &str = "RAYKATA_PARENT";

/// A command for a process that calls [`end_with_parent`]. It names this process, which may have ended before the child can ask.
pub fn child(program: &Path) -> Command {
    let mut command = Command::new(program);
    command.env(PARENT, std::process::id().to_string());
    command
}

/// Ends this process half a second after its parent at the latest. The parent may be killed while student code computes here, which
/// does not notice that the pipe is closed.
pub fn end_with_parent() {
    #[cfg(unix)]
    {
        use std::os::unix::process::parent_id;
        let named = std::env::var(PARENT).ok().and_then(|parent| parent.parse().ok());
        let parent = named.unwrap_or_else(parent_id);
        // A sandbox allows no threads, and ends its processes itself.
        let _ = std::thread::Builder::new().name("parent".into()).spawn(move || {
            while parent_id() == parent {
                std::thread::sleep(Duration::from_millis(500));
            }
            std::process::exit(1);
        });
    }
}

/// A function that answers a request and reports its progress.
pub type AnswerFunction<'a> = dyn Fn(&Request, &dyn Watch) -> Answer + Sync + 'a;

fn answer_all(
    answer: &AnswerFunction<'_>,
    reader: impl Read + 'static,
    writer: impl Write + Send + 'static,
) -> io::Result<()> {
    let (reader, writer) = (Rc::new(RefCell::new(reader)), Arc::new(Mutex::new(writer)));
    let say = {
        let writer = writer.clone();
        move |reply: &Reply| match writer.lock() {
            Ok(mut writer) => send(&mut *writer, reply),
            Err(_) => Err(io::Error::other("a thread ended while it was writing")),
        }
    };
    let ask: questions::Ask = {
        let (say, reader) = (say.clone(), reader.clone());
        Rc::new(move |question: &Question| -> io::Result<Response> {
            say(&Reply::Question(question.clone()))?;
            receive(&mut *reader.borrow_mut())
        })
    };
    loop {
        let request: Request = receive(&mut *reader.borrow_mut())?;
        let progress = ProgressSender { say: &say, tiles: matches!(request, Request::RenderInTiles(_)) };
        let reply = match kit_error::catch(|| match &request {
            Request::Withheld(request) => questions::asking(ask.clone(), || answer(request, &progress)),
            request => answer(request, &progress),
        }) {
            Ok(answer) => Reply::Answer(Box::new(answer)),
            Err(error) => Reply::KitError(error),
        };
        // A line without an end would be lost with the process.
        let _ = io::stdout().flush();
        say(&reply)?;
    }
}

/// Passes progress on to the other side. To cancel, that side ends this process.
struct ProgressSender<'a> {
    say: &'a (dyn Fn(&Reply) -> io::Result<()> + Sync),
    /// Whether the other side wants the pixels of tiles.
    tiles: bool,
}

impl Watch for ProgressSender<'_> {
    fn progress(&self, done: u64, total: u64) {
        // Ignore a closed pipe here, because sending the answer will report it.
        let _ = (self.say)(&Reply::Progress { done, total });
    }

    fn wants_tiles(&self) -> bool {
        self.tiles
    }

    fn tile(&self, tile: &Tile) {
        if self.tiles {
            let _ = (self.say)(&Reply::Tile(tile.clone()));
        }
    }

    fn building(&self, placed: u64, total: u64) {
        let _ = (self.say)(&Reply::Building { placed, total });
    }
}

#[cfg(unix)]
fn pipes() -> io::Result<(impl Read + 'static, impl Write + Send + 'static)> {
    use std::os::fd::AsFd;
    use std::os::unix::net::UnixStream;
    let socket = UnixStream::from(io::stdin().as_fd().try_clone_to_owned()?);
    socket.peer_addr()?;
    let writer = socket.try_clone()?;
    Ok((io::BufReader::new(socket), io::BufWriter::new(writer)))
}

#[cfg(not(unix))]
fn pipes() -> io::Result<(impl Read + 'static, impl Write + Send + 'static)> {
    Ok((io::stdin(), io::stdout()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_survives_the_pipe_and_a_torn_one_is_an_error() {
        let message = Reply::KitError(KitError::Crashed { how: "a test".into() });
        let mut bytes = Vec::new();
        send(&mut bytes, &message).expect("written");
        assert_eq!(receive::<Reply>(&mut &bytes[..]).expect("read"), message);
        for end in 0..bytes.len() {
            let torn = receive::<Reply>(&mut &bytes[..end]).unwrap_err();
            assert_eq!(torn.kind(), io::ErrorKind::UnexpectedEof);
        }
    }

    #[test]
    fn the_times_with_and_without_a_processor_are_the_first_two_numbers() {
        let numbers = [0, 1].map(|place| nanoseconds("123456789 42 7\n", place));
        assert_eq!(numbers, [123_456_789, 42].map(|n| Some(Duration::from_nanos(n))));
        assert_eq!(nanoseconds("", 0), None);
        let ended = Thread::at("no/such/folder".into());
        assert_eq!((ended.waited(), ended.ran()), (Duration::ZERO, None));
    }

    /// A tick of the kernel is 1 to 10 ms, so without the switch a millisecond of work would mostly count as none.
    #[test]
    #[cfg(target_os = "linux")]
    fn the_processor_time_of_a_millisecond_is_not_that_of_a_tick() {
        let computed = |n: u32| {
            let (started, before) = (std::time::Instant::now(), Thread::processor_time().expect("Linux"));
            while started.elapsed() < Duration::from_millis(n.into()) {}
            Thread::processor_time().expect("Linux") - before
        };
        // A busy machine takes the processor away, so that the loop runs for less than its time; the longest of many does not.
        let longest = (0..100).map(|_| computed(1)).max().expect("many");
        assert!(longest >= Duration::from_micros(900), "{longest:?}");
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_thread_is_described_until_it_ends() {
        let folder = || Thread::current().0.expect("it is described").join("schedstat");
        assert!(folder().exists());
        let ended = std::thread::spawn(folder).join().expect("it ends");
        assert_ne!(ended, folder());
    }

    #[test]
    fn a_length_that_nothing_follows_allocates_nothing() {
        let lie = (LONGEST_MESSAGE as u32).to_le_bytes();
        assert!(receive::<Reply>(&mut &lie[..]).is_err());
        let absurd = u32::MAX.to_le_bytes();
        assert!(receive::<Reply>(&mut &absurd[..]).unwrap_err().to_string().contains("4294967295 bytes"));
    }

    #[test]
    fn infinities_and_nan_cross_the_pipe_unchanged() {
        let request = Request::EncodeGamma(vec![f32::INFINITY, -0.0, f32::NAN]);
        let mut bytes = Vec::new();
        send(&mut bytes, &request).expect("written");
        let Request::EncodeGamma(back) = receive(&mut &bytes[..]).expect("read") else { panic!() };
        let bits: Vec<u32> = back.iter().map(|x| x.to_bits()).collect();
        assert_eq!(bits, [f32::INFINITY, -0.0, f32::NAN].map(f32::to_bits));
    }
}
