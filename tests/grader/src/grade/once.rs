//! Results that are computed once per key.

use crate::queue::lock;
use anyhow::Result;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

/// Results by key. Threads that ask for the same key at the same time wait for one of them, which computes the result.
pub struct Once<K, V>(Mutex<BTreeMap<K, Arc<Mutex<Option<V>>>>>);

impl<K, V> Default for Once<K, V> {
    fn default() -> Self {
        Once(Mutex::default())
    }
}

impl<K: Ord, V: Clone> Once<K, V> {
    /// Returns the result for `key`, and computes it if no thread has done so. An error is not kept.
    pub fn get(&self, key: K, compute: impl FnOnce() -> Result<V>) -> Result<V> {
        let place = lock(&self.0).entry(key).or_default().clone();
        let mut place = lock(&place);
        if let Some(known) = &*place {
            return Ok(known.clone());
        }
        let computed = compute()?;
        *place = Some(computed.clone());
        Ok(computed)
    }
}

#[cfg(test)]
mod tests {
    use super::Once;
    use std::sync::atomic::{AtomicU32, Ordering};

    #[test]
    fn each_key_is_computed_once_and_errors_are_not_kept() {
        let (once, computed) = (Once::default(), AtomicU32::new(0));
        assert!(once.get(1, || anyhow::bail!("not yet")).is_err());
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    let square = |key: u32| {
                        once.get(key, || {
                            computed.fetch_add(1, Ordering::Relaxed);
                            Ok(key * key)
                        })
                    };
                    assert_eq!([1, 2].map(|key| square(key).unwrap()), [1, 4]);
                });
            }
        });
        assert_eq!(computed.into_inner(), 2);
    }
}
