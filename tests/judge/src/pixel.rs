//! `raykata check CHECK --pixel X,Y`: one pixel of a picture again, with the input and the answer of each call.

use all_checks::STAGES;
use anyhow::{Context, Result, bail};
use checks::calls::{Batch, Calls};
use checks::paste::Paste;
use checks::picture::{Replay, Replayed};
use checks::{Check, Inputs, examine};
use raykata::kit::{Answer, Kit, KitError};
use raykata_cli::kits::Source;
use std::fmt::{Debug, Write};
use std::sync::Arc;

/// The largest number of calls that are printed for one batch; a cell of a picture of random samples has hundreds.
const MOST_CALLS: usize = 16;

/// The longest text of an input or an answer, in characters: a tree with all its nodes is longer.
const LONGEST: usize = 600;

/// Prints the calls for the pixel `at`, such as `12,7`, of the picture of the check `name`; `Ok(true)` if its colour is right.
pub fn replay(source: &Source, name: &str, at: &str) -> Result<bool> {
    let check = find(name)?;
    let (x, y) = at
        .split_once(',')
        .and_then(|(x, y)| Some((x.trim().parse().ok()?, y.trim().parse().ok()?)))
        .with_context(|| format!("`--pixel {at}`: a pixel is its column and its row, such as 12,7"))?;
    let (text, is_right) = report(check, source.fresh(), x, y)?;
    raykata_cli::report::say(format_args!("{text}"));
    Ok(is_right)
}

/// The check with this name.
pub(crate) fn find(name: &str) -> Result<&'static Check> {
    match STAGES.iter().flat_map(|(_, checks)| checks.iter()).find(|check| check.name == name) {
        Some(check) => Ok(check),
        None => Err(raykata_cli::list::entry(name).err().context("the rubric lists no such check")?),
    }
}

/// The report about a pixel, and whether its colour is right.
fn report(check: &Check, kit: Arc<dyn Kit + Send + Sync>, x: u32, y: u32) -> Result<(String, bool)> {
    let replay = Arc::new(Replay::new(x, y));
    let calls = Calls::default();
    let inputs = Inputs { pixel: Some(Arc::clone(&replay)), calls: Some(calls.clone()), ..Inputs::default() };
    let outcome = examine(check, &kit, 0, inputs);
    let Some(result) = replay.result() else {
        match outcome {
            Ok(Err(broken)) if broken.source == "the golden picture" => {
                bail!("{}: {}", broken.input, broken.yours)
            }
            _ => bail!(
                "the check `{}` compares no picture, so it has no pixels. `cargo test --test stage{} {}` runs it",
                check.name,
                check.stage,
                check.name
            ),
        }
    };
    let size = result.size;
    if result.expected.is_none() {
        bail!(
            "pixel {x},{y} lies outside of the picture, which has {} columns and {} rows, numbered from 0",
            size.width,
            size.height
        );
    }
    Ok((text(&result, (x, y), &calls.batches(), outcome.err()), !result.differs()))
}

fn text(result: &Replayed, (x, y): (u32, u32), batches: &[Batch], error: Option<KitError>) -> String {
    let mut text = format!("column {x}, row {y} of the picture tests/golden/{}.png\n", result.picture);
    let _ = match &result.ray {
        Some(ray) => writeln!(text, "  the ray   {}\n", ray.paste()),
        None => writeln!(
            text,
            "  The picture is made of random samples. These are other samples of the same pixel.\n"
        ),
    };
    let calls = batches.iter().filter_map(|(request, answer)| Some((request.queries()?, answer)));
    for ((function, queries), answer) in calls {
        let answers = answer.as_ref().map(Answer::values).unwrap_or_default();
        for (index, query) in queries.iter().enumerate().take(MOST_CALLS) {
            let answer = answers.get(index).map_or("no answer".into(), |answer| shorten(answer));
            let _ = writeln!(text, "  {function}\n    input   {}\n    yours   {answer}", shorten(query));
        }
        if queries.len() > MOST_CALLS {
            let _ = writeln!(text, "    … and {} more calls of {function}", queries.len() - MOST_CALLS);
        }
    }
    if let Some(error) = error {
        let _ = writeln!(text, "\n  {error}");
    }
    let expected = result.expected.unwrap_or_default();
    let yours = result.yours.map_or("no colour".into(), |color| format!("{color:.4}"));
    let verdict = match (result.differs(), result.ray) {
        (false, _) => "equal within the tolerance of a byte",
        (true, Some(_)) => "different",
        (true, None) => "different, which may be chance: the check compares means of blocks of pixels",
    };
    let _ = writeln!(
        text,
        "\n  colour, linear: red, green, blue\n    yours     {yours}\n    expected  {expected:.4} (the golden picture)\n    {verdict}"
    );
    text
}

/// A value as text, cut if it is long.
pub(crate) fn shorten(value: &dyn Debug) -> String {
    let text = format!("{value:?}");
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} …", &text[..end]),
        None => text,
    }
}
