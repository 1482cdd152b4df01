//! The worker: a process that holds a kit and answers requests, one after the other, until the pipe closes.
//!
//! Messages are `postcard` bytes behind a four-byte length. On Unix both directions run through the socket that the
//! other side passes as standard input, so that nothing that student code prints can get between two messages;
//! elsewhere requests come through standard input and replies leave through standard output.

use crate::frame::Watch;
use crate::kit::{Answer, Mishap, Request, StudentKit, mishap};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::io::{self, Read, Write};
use std::sync::Mutex;

/// Longer messages are refused: nothing that a check or a scene needs comes near.
pub const LONGEST_MESSAGE: usize = 1 << 30;

/// Room for the recursion of student code: depth 100,000 at a few hundred bytes a call.
pub const STACK_BYTES: usize = 64 << 20;

/// What a worker says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Reply {
    /// A frame has got this far; the answer is still to come.
    Progress {
        /// Finished pixels.
        done: u64,
        /// All pixels.
        total: u64,
    },
    /// What a frame needs before its first pixel has got this far.
    Building {
        /// Primitives that are in leaves.
        placed: u64,
        /// All primitives.
        total: u64,
    },
    /// The answer.
    Answer(Box<Answer>),
    /// There is none.
    Mishap(Mishap),
}

/// Writes one message.
pub fn send<T: Serialize>(pipe: &mut impl Write, message: &T) -> io::Result<()> {
    let bytes = postcard::to_stdvec(message).map_err(io::Error::other)?;
    let length = u32::try_from(bytes.len()).map_err(io::Error::other)?;
    pipe.write_all(&length.to_le_bytes())?;
    pipe.write_all(&bytes)?;
    pipe.flush()
}

/// Reads one message; fails with [`io::ErrorKind::UnexpectedEof`] when the other side has closed the pipe.
///
/// What is not a message fails with [`io::ErrorKind::Other`].
pub fn receive<T: DeserializeOwned>(pipe: &mut impl Read) -> io::Result<T> {
    receive_up_to(pipe, LONGEST_MESSAGE)
}

/// The same, of at most `longest` bytes.
pub fn receive_up_to<T: DeserializeOwned>(pipe: &mut impl Read, longest: usize) -> io::Result<T> {
    let mut length = [0; 4];
    pipe.read_exact(&mut length)?;
    let length = u32::from_le_bytes(length) as usize;
    if length > longest {
        return Err(io::Error::other(format!("a message of {length} bytes")));
    }
    // Grows with what arrives: a length alone is no reason to allocate.
    let mut bytes = Vec::new();
    pipe.take(length as u64).read_to_end(&mut bytes)?;
    if bytes.len() < length {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    postcard::from_bytes(&bytes).map_err(|error| io::Error::other(format!("no message: {error}")))
}

/// Answers requests with the functions of a crate until the pipe closes. The whole of a worker's `main`.
pub fn serve(functions: impl StudentKit) {
    let kit = functions.door();
    serve_with(&|request, watch| request.answer(&*kit, watch));
}

/// The same with any function in place of a kit.
pub fn serve_with(answer: &Answering<'_>) {
    let work = || {
        let (reader, writer) = pipes()?;
        answer_all(answer, reader, writer)
    };
    let served = std::thread::scope(|scope| {
        let deep = std::thread::Builder::new().name("exercise".into()).stack_size(STACK_BYTES);
        match deep.spawn_scoped(scope, work) {
            Ok(thread) => thread.join().unwrap_or(Ok(())),
            // In a jail there are no threads, and whoever made it has given this one a deep stack.
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

/// Something that answers requests.
pub type Answering<'a> = dyn Fn(&Request, &dyn Watch) -> Answer + Sync + 'a;

fn answer_all(answer: &Answering<'_>, mut reader: impl Read, writer: impl Write + Send) -> io::Result<()> {
    let writer = Mutex::new(writer);
    let say = |reply: &Reply| match writer.lock() {
        Ok(mut writer) => send(&mut *writer, reply),
        Err(_) => Err(io::Error::other("a thread ended while it was writing")),
    };
    loop {
        let request: Request = receive(&mut reader)?;
        let reply = match mishap::catch(|| answer(&request, &Relay(&say))) {
            Ok(answer) => Reply::Answer(Box::new(answer)),
            Err(mishap) => Reply::Mishap(mishap),
        };
        say(&reply)?;
    }
}

/// Passes progress on to the other side. To cancel, that side ends this process.
struct Relay<'a>(&'a (dyn Fn(&Reply) -> io::Result<()> + Sync));

impl Watch for Relay<'_> {
    fn progress(&self, done: u64, total: u64) {
        // If nobody listens any more, the next answer will find out.
        let _ = (self.0)(&Reply::Progress { done, total });
    }

    fn building(&self, placed: u64, total: u64) {
        let _ = (self.0)(&Reply::Building { placed, total });
    }
}

#[cfg(unix)]
fn pipes() -> io::Result<(impl Read, impl Write + Send)> {
    use std::os::fd::AsFd;
    use std::os::unix::net::UnixStream;
    let socket = UnixStream::from(io::stdin().as_fd().try_clone_to_owned()?);
    socket.peer_addr()?;
    let writer = socket.try_clone()?;
    Ok((io::BufReader::new(socket), io::BufWriter::new(writer)))
}

#[cfg(not(unix))]
fn pipes() -> io::Result<(impl Read, impl Write + Send)> {
    Ok((io::stdin(), io::stdout()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_survives_the_pipe_and_a_torn_one_is_an_error() {
        let message = Reply::Mishap(Mishap::Crashed { how: "a test".into() });
        let mut bytes = Vec::new();
        send(&mut bytes, &message).expect("written");
        assert_eq!(receive::<Reply>(&mut &bytes[..]).expect("read"), message);
        for end in 0..bytes.len() {
            let torn = receive::<Reply>(&mut &bytes[..end]).unwrap_err();
            assert_eq!(torn.kind(), io::ErrorKind::UnexpectedEof);
        }
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
