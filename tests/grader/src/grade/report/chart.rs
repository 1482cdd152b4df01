//! Charts: a histogram of points, and bars of outcomes. `style.css` sets the colours.

use super::tally::Tally;
use crate::grade::result::Outcome;
use maud::{Markup, html};

/// Size of the histogram, in SVG units.
const WIDTH: u32 = 520;
const HEIGHT: u32 = 190;
const ABOVE: u32 = 20;
const BELOW: u32 = 24;

/// Draws how many students have how many points.
pub(super) fn histogram(points: &[u32], of: u32) -> Markup {
    let step = step(of);
    let n_bins = of / step + 1;
    let mut counts = vec![0u32; n_bins as usize];
    for points in points {
        counts[(points / step).min(n_bins - 1) as usize] += 1;
    }
    let most = counts.iter().copied().max().unwrap_or(0).max(1);
    let slot = WIDTH / n_bins;
    let bottom = HEIGHT - BELOW;
    html! {
        svg.histogram viewBox=(format!("0 0 {} {HEIGHT}", slot * n_bins)) role="img" aria-label="Number of submissions per range of points" {
            @for (n, i) in counts.into_iter().zip(0..) {
                @let (from, to) = (i * step, (i * step + step - 1).min(of));
                @let height = (bottom - ABOVE) * n / most;
                @let (left, top) = (i * slot, bottom - height);
                g {
                    title { (from) "–" (to) " points: " (n) }
                    rect x=(left + 2) y=(top) width=(slot.saturating_sub(4)) height=(height) rx="2" {}
                    @if n > 0 {
                        text.count x=(left + slot / 2) y=(top - 5) { (n) }
                    }
                    text x=(left + slot / 2) y=(HEIGHT - 8) { (from) }
                }
            }
            line x1="0" x2=(slot * n_bins) y1=(bottom) y2=(bottom) {}
        }
    }
}

/// Chooses a round column width, in points, that gives about twelve columns.
fn step(of: u32) -> u32 {
    let steps = [1, 2, 5, 10, 20, 25, 50, 100, 200, 500];
    steps.into_iter().find(|step| of / step <= 13).unwrap_or(of.max(1).div_ceil(12))
}

/// Draws the share of the class per outcome.
pub(super) fn outcomes(tally: &Tally) -> Markup {
    html! {
        span.bar {
            @for (outcome, n) in tally.outcomes() {
                span class={ "part " (class(outcome)) } style={ "flex-grow:" (n) } title={ (outcome.words()) ": " (n) } {}
            }
        }
    }
}

/// Draws the share of points that was earned.
pub(super) fn share(earned: u32, of: u32) -> Markup {
    html! {
        span.bar {
            @if earned > 0 { span.part.passed style={ "flex-grow:" (earned) } {} }
            @if earned < of { span.part.rest style={ "flex-grow:" (of - earned) } {} }
        }
    }
}

/// Explains the colours.
pub(super) fn legend() -> Markup {
    html! {
        p.legend {
            @for outcome in Outcome::ALL {
                span { span class={ "key " (class(outcome)) } {} (outcome.words()) }
            }
        }
    }
}

/// Returns the CSS class of an outcome.
pub(super) fn class(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Passed => "passed",
        Outcome::NotWritten => "not-written",
        Outcome::Wrong => "wrong",
        Outcome::WrongOnHidden => "hidden-wrong",
        Outcome::Unproven => "unproven",
        Outcome::TooLong => "too-long",
        Outcome::Crashed => "crashed",
        Outcome::DoesNotCompile => "no-compile",
        Outcome::Refused => "refused",
        Outcome::NotTried => "not-tried",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_few_columns_and_the_last_one_ends_with_all_points() {
        for of in (0..2000).chain([50_000]) {
            assert!((1..=14).contains(&(of / step(of) + 1)), "{of}");
        }
        let drawn = histogram(&[0, 9, 10, 100], 100).into_string();
        assert!(drawn.contains("<title>0–9 points: 2</title>"), "{drawn}");
        assert!(drawn.contains("<title>100–100 points: 1</title>"), "{drawn}");
    }
}
