//! Messages to all open pages, as server-sent events.

use raykata_cli::queue::lock;
use serde_json::Value;
use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex};

/// The most messages that wait for a page. A page that is slower is cut off; it connects again and gets the whole picture.
const MOST_WAITING: usize = 4096;

/// The most open pages. One more replaces the oldest.
const MOST_PAGES: usize = 16;

/// Closes the connection of a page, also while a message is written to it.
pub type Close = Box<dyn FnOnce() + Send>;

/// The open pages, the oldest first.
#[derive(Default)]
pub struct Pages(Mutex<VecDeque<(SyncSender<Arc<str>>, Close)>>);

impl Pages {
    /// A new page, which receives all later messages until `close` is called.
    pub fn open(&self, close: Close) -> Receiver<Arc<str>> {
        let (sender, receiver) = sync_channel(MOST_WAITING);
        let mut pages = lock(&self.0);
        if pages.len() == MOST_PAGES
            && let Some((_, close)) = pages.pop_front()
        {
            close();
        }
        pages.push_back((sender, close));
        receiver
    }

    /// Sends a message to all pages, and forgets those that are closed or too slow.
    pub fn publish(&self, event: &str, data: &Value) {
        let message: Arc<str> = message(event, data).into();
        lock(&self.0).retain(|(page, _)| page.try_send(message.clone()).is_ok());
    }
}

/// A message: its name, and one line of JSON.
pub fn message(event: &str, data: &Value) -> String {
    format!("event: {event}\ndata: {data}\n\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_message_has_one_line_of_data_whatever_the_text_is() {
        let text = "line 1\nline 2\r\nevent: forged\n\n\u{2028}end";
        let sent = message("errors", &json!({ "words": text }));
        let lines: Vec<&str> = sent.split(['\n', '\r']).collect();
        assert_eq!(lines.len(), 4, "{sent:?}");
        assert_eq!((lines[0], lines[2], lines[3]), ("event: errors", "", ""));
        let data: Value = serde_json::from_str(lines[1].strip_prefix("data: ").unwrap()).unwrap();
        assert_eq!(data["words"], text);
    }

    #[test]
    fn a_page_that_reads_nothing_is_cut_off() {
        let pages = Pages::default();
        let (slow, fast) = (pages.open(Box::new(|| ())), pages.open(Box::new(|| ())));
        for _ in 0..=MOST_WAITING {
            pages.publish("tile", &json!(1));
            assert!(fast.recv().is_ok());
        }
        assert_eq!(slow.try_iter().count(), MOST_WAITING);
        assert!(slow.recv().is_err(), "its channel is closed");
        pages.publish("tile", &json!(2));
        assert!(fast.recv().is_ok());
    }
}
