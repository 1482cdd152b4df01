//! Work on several threads: a free thread takes the next item, and locks outlive a panic.

use anyhow::{Result, bail};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Workers without state, one per core.
pub fn one_a_core() -> Vec<()> {
    vec![(); cores()]
}

/// The number of threads that run at the same time.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Locks a mutex, also if a thread has panicked while it held the lock.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The results of `work` for all items, in the order of the items; each worker has a thread. After an error
/// no other item is started, and the error of the first item that has one is returned.
pub fn run<W: Sync, I: Sync, T: Send>(
    workers: &[W],
    items: &[I],
    work: impl Fn(&W, &I) -> Result<T> + Sync,
) -> Result<Vec<T>> {
    assert!(items.is_empty() || !workers.is_empty(), "there are no workers for the items");
    let next = AtomicUsize::new(0);
    let job = |worker: &W| {
        let mut done = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else { return done };
            let result = work(worker, item);
            if result.is_err() {
                next.fetch_max(items.len(), Ordering::Relaxed);
            }
            done.push((index, result));
        }
    };
    let joined: Vec<_> = std::thread::scope(|scope| {
        let running: Vec<_> = workers.iter().map(|worker| scope.spawn(|| job(worker))).collect();
        running.into_iter().map(|thread| thread.join()).collect()
    });
    let mut results = Vec::new();
    for done in joined {
        match done {
            Ok(done) => results.extend(done),
            Err(_) => bail!("a job panicked: see the message above"),
        }
    }
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::run;
    use anyhow::bail;

    #[test]
    fn results_have_the_order_of_the_items() {
        let items: Vec<usize> = (0..200).collect();
        let squares = run(&[0, 1, 2], &items, |_, item| Ok(item * item)).unwrap();
        assert_eq!(squares, items.iter().map(|item| item * item).collect::<Vec<_>>());
        assert!(run(&[(); 0], &[(); 0], |(), ()| Ok(())).unwrap().is_empty());
    }

    #[test]
    fn the_first_error_is_returned_and_nothing_more_is_begun() {
        let begun = std::sync::Mutex::new(Vec::new());
        let error = run(&[()], &[1, 2, 3, 4], |(), item| {
            begun.lock().unwrap().push(*item);
            if item % 2 == 0 { bail!("item {item}") } else { Ok(()) }
        });
        assert_eq!(error.unwrap_err().to_string(), "item 2");
        assert_eq!(begun.into_inner().unwrap(), [1, 2]);
    }

    #[test]
    fn a_job_that_panics_is_an_error() {
        let broken = run(&[(), ()], &[1, 2, 3], |(), item| {
            assert!(*item != 2, "as this test wants it");
            Ok(())
        });
        assert!(broken.unwrap_err().to_string().contains("panicked"));
    }
}
