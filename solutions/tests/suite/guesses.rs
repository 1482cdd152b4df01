//! Answers without knowledge of the task: a program that knows the rubric and all public questions with their answers (unless
//! `CI_LONG=1`, the first 2,000 of a batch), and answers hidden questions by their place in the check, as the nearest one, or by a
//! constant, earns at most 5 % of the points of any stage. Functions that do not look at their arguments pass no check.

use all_checks::STAGES;
use checks::calls::swaps;
use checks::{Check, Drawn, Inputs, ONE_HIDDEN_IN, rubric};
use raykata::frame::{Unwatched, Watch};
use raykata::kit::{Answer, Door, Kit, Request, Transport};
use raykata::message::{from_bytes, to_bytes};
use std::borrow::Borrow;
use std::cmp::Reverse;
use std::collections::{HashMap, HashSet};
use std::sync::{Arc, Mutex, OnceLock};

/// The bytes before the items of a request or an answer: the number of its function, and how many items there are.
const HEADER: usize = 5;

/// Whether all guesses are tried, with two seeds and all that is known.
fn is_long() -> bool {
    std::env::var_os("CI_LONG").is_some()
}

/// How many questions of a batch are known. Larger batches only judge distributions, whose numbers are different for each seed; their
/// questions are answered by their place among the known ones.
fn most_known() -> usize {
    if is_long() { usize::MAX } else { 2000 }
}

/// A public question and its right answer.
struct Example {
    question: Request,
    answer: Vec<u8>,
    /// The numbers of the question, once they are needed.
    numbers: OnceLock<Vec<f64>>,
}

/// The public questions of a check to one function.
#[derive(Default)]
struct Known {
    batches: Vec<Vec<Example>>,
    /// The answer to each question.
    answers: HashMap<Vec<u8>, Vec<u8>>,
    /// All answers, the most frequent one first.
    frequent: Vec<Vec<u8>>,
}

/// By function.
type Knowledge = HashMap<u8, Known>;

/// A check with what is known of it.
type Learnt = (&'static Check, Arc<Knowledge>);

/// How a question that is not known is answered.
#[derive(Clone, Copy, Debug)]
enum Guess {
    /// As the question with the same place in the same batch.
    Place,
    /// As the known question with the nearest numbers.
    Nearest,
    /// By the most frequent answer, or the second or third.
    Frequent(usize),
}

/// Hidden seeds: the first one with the first three guesses, or both with all guesses.
const SEEDS: [u64; 2] = [77, 0x1234_5678_9abc];

const GUESSES: [Guess; 5] =
    [Guess::Place, Guess::Nearest, Guess::Frequent(0), Guess::Frequent(1), Guess::Frequent(2)];

/// How many questions a request asks.
fn n_questions(request: &Request) -> usize {
    request.queries().expect("a call of a function").1.len()
}

/// The first questions of a request, at most `most`, one by one.
fn questions(request: &Request, most: usize) -> Vec<Request> {
    (0..most).map_while(|i| request.only(i)).collect()
}

/// The numbers of a question.
fn numbers(question: &Request) -> Vec<f64> {
    let text = format!("{:?}", question.queries().expect("a call of a function").1);
    let words = text.split(|letter: char| !(letter.is_ascii_alphanumeric() || "+-.".contains(letter)));
    words.filter_map(|word| word.parse().ok()).collect()
}

/// The answer with these items.
fn joined<T: Borrow<[u8]>>(function: u8, items: &[T]) -> Answer {
    let header = [&[function][..], &(items.len() as u32).to_le_bytes()].concat();
    from_bytes(&[header, items.concat()].concat()).expect("an answer")
}

/// Asks the reference, and keeps questions and answers.
struct Learner {
    reference: Arc<dyn Kit + Send + Sync>,
    knowledge: Arc<Mutex<Knowledge>>,
}

impl Transport for Learner {
    fn call(&self, request: Request, _: &dyn Watch) -> Answer {
        let learn = |question: Request| {
            let answer = to_bytes(&question.answer(&*self.reference, &Unwatched))[HEADER..].to_vec();
            Example { question, answer, numbers: OnceLock::new() }
        };
        let answer = request.answer(&*self.reference, &Unwatched);
        let function = to_bytes(&answer)[0];
        let batch: Vec<_> = questions(&request, most_known()).into_iter().map(learn).collect();
        self.knowledge.lock().expect("no panic").entry(function).or_default().batches.push(batch);
        answer
    }
}

impl Known {
    /// Finds the answer to each question and the most frequent answers.
    fn complete(&mut self) {
        let mut times = HashMap::<&[u8], usize>::new();
        for one in self.batches.iter().flatten() {
            *times.entry(&one.answer).or_default() += 1;
            self.answers.insert(to_bytes(&one.question)[HEADER..].to_vec(), one.answer.clone());
        }
        let mut times: Vec<_> =
            times.into_iter().map(|(answer, times)| (Reverse(times), answer.to_vec())).collect();
        times.sort_unstable();
        self.frequent = times.into_iter().map(|(_, answer)| answer).collect();
    }
}

/// Answers hidden questions by `guess`.
struct Guesser {
    knowledge: Arc<Knowledge>,
    guess: Guess,
    seed: u64,
    /// How many batches of each function came.
    batches: Mutex<HashMap<u8, usize>>,
}

impl Guesser {
    /// The answers to the questions of a batch, if there are any to choose from.
    fn answers(&self, known: &Known, batch: usize, request: &Request) -> Option<Vec<Vec<u8>>> {
        let n = n_questions(request);
        if n > most_known() {
            let known = known.batches.get(batch)?;
            return Some((0..n).map(|place| known[place % known.len()].answer.clone()).collect());
        }
        // Compare a large batch with few known questions, so that a picture takes seconds.
        let n_near = (100_000 / n.max(1)).max(16);
        let all: Vec<&Example> = known.batches.iter().flatten().collect();
        let near: Vec<&Example> = all.iter().step_by(all.len().div_ceil(n_near).max(1)).copied().collect();
        let answer = |(place, question): (usize, Request)| -> Option<&Vec<u8>> {
            if let Some(answer) = known.answers.get(&to_bytes(&question)[HEADER..]) {
                return Some(answer);
            }
            match self.guess {
                Guess::Place => Some(&known.batches.get(batch)?.get(place)?.answer),
                Guess::Nearest => {
                    let these = numbers(&question);
                    let distance =
                        |one: &Example| distance(one.numbers.get_or_init(|| numbers(&one.question)), &these);
                    let distances = near.iter().map(|one| (distance(one), &one.answer));
                    Some(distances.min_by(|p, q| p.0.total_cmp(&q.0))?.1)
                }
                Guess::Frequent(rank) => known.frequent.get(rank),
            }
        };
        questions(request, n).into_iter().enumerate().map(|question| answer(question).cloned()).collect()
    }
}

impl Transport for Guesser {
    fn call(&self, request: Request, _: &dyn Watch) -> Answer {
        let function = to_bytes(&request)[0];
        let mut batches = self.batches.lock().expect("no panic");
        let batch = batches.entry(function).or_default();
        let known = self.knowledge.get(&function);
        let answers = known.and_then(|known| self.answers(known, *batch, &request)).unwrap_or_default();
        *batch += 1;
        joined(function, &answers)
    }

    fn swaps(&self, n: usize) -> Vec<(usize, usize)> {
        swaps(self.seed, n)
    }
}

/// What a function answers to every question.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Constant {
    /// `None`, `false`, 0 or an empty list.
    Least,
    /// These words again and again.
    Filled([u32; 3]),
    /// An argument that begins at this byte, unchanged, or `Some` of it.
    Argument(usize),
}

const ONE: u32 = 1f32.to_bits();

/// The last words are the vertical axis.
const CONSTANTS: [Constant; 7] = [
    Constant::Least,
    Constant::Filled([1; 3]),
    Constant::Filled([ONE; 3]),
    Constant::Filled([f32::NAN.to_bits(); 3]),
    Constant::Filled([0, ONE, 0]),
    Constant::Argument(0),
    Constant::Argument(12),
];

/// Constants that are right in all that a check asks. The point from which a shadow ray starts is not too high above itself.
const RIGHT_BY_CHANCE: [(&str, Constant); 1] = [("shadow_ray_sees_what_is_close", Constant::Argument(0))];

/// Functions that do not look at their arguments.
struct Constants {
    knowledge: Arc<Knowledge>,
    constant: Constant,
}

impl Transport for Constants {
    fn call(&self, request: Request, _: &dyn Watch) -> Answer {
        let function = to_bytes(&request)[0];
        let right = self.knowledge.get(&function).map(|known| &known.frequent[..]).unwrap_or_default();
        let length = right.iter().map(Vec::len).max().unwrap_or_default();
        let answer = |question: Request| {
            let bytes = match self.constant {
                Constant::Least => Vec::new(),
                Constant::Filled(words) => words.map(u32::to_le_bytes).as_flattened().repeat(length / 12 + 1),
                Constant::Argument(start) => {
                    to_bytes(&question)[HEADER..].iter().skip(start).copied().collect()
                }
            };
            let value = bytes.get(..length).map(<[u8]>::to_vec);
            let some = bytes.get(..length.saturating_sub(1)).map(|value| [&[1], value].concat());
            let least = [vec![0], vec![0; 4], vec![0; length]];
            let mut constants = value.into_iter().chain(some).chain(least);
            constants
                .find(|bytes| from_bytes::<Answer>(&[&[function, 1, 0, 0, 0], &bytes[..]].concat()).is_ok())
        };
        let n = n_questions(&request);
        // Only an argument depends on the question.
        let asked = if matches!(self.constant, Constant::Argument(_)) { n } else { n.min(1) };
        let answers: Vec<Vec<u8>> = questions(&request, asked).into_iter().filter_map(answer).collect();
        joined(function, &answers.iter().map(Vec::as_slice).cycle().take(n).collect::<Vec<_>>())
    }
}

/// The sum of the differences of two lists of numbers, each at most 1.
fn distance(these: &[f64], those: &[f64]) -> f64 {
    let difference = |(p, q): (&f64, &f64)| {
        let part = (p - q).abs() / (p.abs() + q.abs() + 1.0);
        // An infinite distance over an infinite sum is NaN, of which `min` returns 1.
        if p.to_bits() == q.to_bits() { 0.0 } else { part.min(1.0) }
    };
    these.len().abs_diff(those.len()) as f64 + these.iter().zip(those).map(difference).sum::<f64>()
}

/// Guesses earn at most 5 % of the points of a stage.
fn guesses_earn_little(stage: u8) {
    let reference = checks::linked(solutions::Kit);
    let (_, checks) = STAGES.iter().find(|(number, _)| *number == stage).expect("a stage");
    let points = |check: &Check| rubric::entry(stage, check.name).points;
    let drawn = Arc::<Drawn>::default();
    let passes = |check: &Check, kit: Arc<dyn Kit + Send + Sync>, seed, one_in| {
        let (drawn, reference) = (Some(drawn.clone()), Some(reference.clone()));
        let inputs = Inputs { drawn, reference, one_in, shrinks: false, ..Inputs::default() };
        matches!(checks::examine(check, &kit, seed, inputs), Ok(Ok(())))
    };
    let learn = |check: &'static Check| {
        let knowledge = Arc::<Mutex<Knowledge>>::default();
        let learner = Learner { reference: reference.clone(), knowledge: knowledge.clone() };
        assert!(passes(check, Arc::new(Door(learner)), 0, 1), "the reference fails {}", check.name);
        let mut knowledge = std::mem::take(&mut *knowledge.lock().expect("no panic"));
        knowledge.values_mut().for_each(Known::complete);
        (check, Arc::new(knowledge))
    };
    let (mut most, learnt): (u32, Vec<Learnt>) = (0, checks.iter().map(learn).collect());
    let total: u32 = checks.iter().map(points).sum();
    // A check that asks for `None` or 0 in some cases has others.
    for constant in CONSTANTS {
        let is_passed = |(check, knowledge): &&Learnt| {
            passes(check, Arc::new(Door(Constants { knowledge: knowledge.clone(), constant })), 0, 1)
        };
        let passed = learnt.iter().filter(is_passed).map(|(check, _)| check.name);
        let named: Vec<&str> = passed.filter(|name| !RIGHT_BY_CHANCE.contains(&(*name, constant))).collect();
        assert!(named.is_empty(), "{constant:?} passes {named:?} of stage {stage}");
    }
    let (n_seeds, n_guesses) = if is_long() { (2, 5) } else { (1, 3) };
    let guesses = |seed| GUESSES.into_iter().take(n_guesses).map(move |guess| (seed, guess));
    for (seed, guess) in SEEDS.into_iter().take(n_seeds).flat_map(guesses) {
        let is_passed = |(check, knowledge): &&Learnt| {
            let batches = Mutex::default();
            let guesser = Guesser { knowledge: knowledge.clone(), guess, seed, batches };
            passes(check, Arc::new(Door(guesser)), seed, ONE_HIDDEN_IN)
        };
        let passed: Vec<&Learnt> = learnt.iter().filter(is_passed).collect();
        // As the grader counts: turned inputs count if a check of the same function with drawn ones passes, or if there is none.
        let draws = |(check, _): &&Learnt| !check.symmetries.turn_public_inputs();
        let asks = |(_, knowledge): &Learnt| knowledge.keys().copied().collect::<HashSet<u8>>();
        let proven: HashSet<u8> = passed.iter().copied().filter(draws).flat_map(asks).collect();
        let counts = |one: &&Learnt| {
            let open: HashSet<u8> = asks(one).difference(&proven).copied().collect();
            draws(one) || !learnt.iter().filter(draws).any(|other| !asks(other).is_disjoint(&open))
        };
        let earned: Vec<&Check> = passed.into_iter().filter(counts).map(|(check, _)| *check).collect();
        let points: u32 = earned.iter().copied().map(points).sum();
        let names: Vec<&str> = earned.iter().map(|check| check.name).collect();
        println!("stage {stage}, seed {seed}, {guess:?}: {points} of {total} points, {names:?}");
        most = most.max(points);
    }
    assert!(20 * most <= total, "{most} of {total} points of stage {stage} for guesses");
}

macro_rules! stages {
    ($($name:ident $stage:literal)*) => {
        $(#[test]
        fn $name() {
            guesses_earn_little($stage);
        })*
    };
}

stages! {
    stage1 1 stage2 2 stage3 3 stage4 4 stage5 5 stage6 6 stage7 7 stage8 8 stage9 9 stage10 10 stage11 11 stage12 12
}
