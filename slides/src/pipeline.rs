//! The diagram of grading: the judge, and the worker in its sandbox.

use anyhow::Result;
use raykata::kit::Kit;
use raykata_cli::svg::{Drawing, End, Ink, Middle, SMALL, Start, TEXT};

/// The judge asks questions, and the worker answers from inside a sandbox.
pub fn judge_and_worker(_kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The judge, and the worker in its sandbox", 1000.0, 600.0);
    let (judge, worker, closed) = (Ink::Color(0), Ink::Color(2), Ink::Color(1));
    drawing.frame([30.0, 40.0], [330.0, 340.0], judge.pen(4.0));
    drawing.text([50.0, 80.0], Start, TEXT, judge, "judge");
    let lines = ["inputs", "expectations", "tolerances", "counts", "verdict"];
    drawing.lines([50.0, 130.0], 42.0, TEXT, Ink::Text, &lines);
    drawing.frame([540.0, 20.0], [970.0, 360.0], closed.pen(3.0).dashed());
    drawing.text([960.0, 350.0], End, SMALL, closed, "sandbox");
    drawing.frame([580.0, 60.0], [840.0, 310.0], worker.pen(4.0));
    drawing.text([600.0, 100.0], Start, TEXT, worker, "worker");
    drawing.lines([600.0, 160.0], 42.0, TEXT, Ink::Text, &["glue", "your functions"]);
    drawing.arrow([340.0, 140.0], [572.0, 140.0], judge.pen(4.0));
    drawing.text([435.0, 126.0], Middle, SMALL, judge, "questions");
    drawing.arrow([572.0, 230.0], [340.0, 230.0], worker.pen(4.0));
    drawing.text([435.0, 216.0], Middle, SMALL, worker, "answers");
    drawing.text([435.0, 290.0], Middle, SMALL, Ink::Text, "one socket");
    // Nothing else leaves the sandbox.
    for (row, what) in ["files", "network", "children"].into_iter().enumerate() {
        let y = 100.0 + 80.0 * row as f64;
        drawing.arrow([842.0, y], [945.0, y], Ink::Faint.pen(3.0));
        drawing.line([880.0, y - 14.0], [908.0, y + 14.0], closed.pen(5.0));
        drawing.line([880.0, y + 14.0], [908.0, y - 14.0], closed.pen(5.0));
        drawing.text([908.0, y - 20.0], Middle, SMALL, Ink::Text, what);
    }
    drawing.frame([540.0, 400.0], [970.0, 560.0], closed.pen(3.0).dashed());
    drawing.text([960.0, 550.0], End, SMALL, closed, "sandbox");
    drawing.frame([580.0, 430.0], [900.0, 510.0], worker.pen(4.0));
    drawing.text([740.0, 478.0], Middle, SMALL, worker, "the same, hidden");
    drawing.polyline(&[[180.0, 340.0], [180.0, 470.0], [560.0, 470.0]], judge.pen(4.0));
    drawing.arrow([540.0, 470.0], [576.0, 470.0], judge.pen(4.0));
    drawing.text([350.0, 456.0], Middle, SMALL, judge, "hidden inputs");
    Ok(drawing.svg())
}
