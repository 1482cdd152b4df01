//! Tests that the hand-out contains no function that answers an exercise. Every function with fitting types is pasted into
//! the exercise, and the checks of that stage must reject it. `paste/candidates.snap` records which functions fit. The long
//! run builds them in and runs the checks.

mod call;
mod collect;
mod copy;

use super::program_runs::{leaves_out_what_takes_long, root};
use collect::{Function, bundles, candidates, functions, functions_of};
use grader::exercises;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Functions that may answer an exercise, each with the reason.
const EXCEPTIONS: [&str; 9] = [
    // The height of a landscape at two coordinates.
    "raykata_cli::cost::landscape::height in stage11_light_transport::mis_weight",
    // A quantile of Student's distribution.
    "raykata_cli::cost::slope::quantile_of_t in stage12_build::block_cost",
    // The wrong way, with which the checks compare.
    "judge::boxes_and_offsets::moved_by_a_fixed_distance in stage10_stability::offset_origin",
    // A mean, in a test of the scaffold.
    "raykata::tracer::driver::tests::mean in stage6_distribution::filter_pixel",
    // A product of transforms in a test of the scaffold, in single precision and without a refusal.
    "raykata::tracer::light::emitters::tests::place in stage8_scene_graph::placement",
    // The slide's one-line formula in double precision.
    "stage4_checks::terms::specular in stage4_shading::specular_term",
    // The slide's formula in double precision.
    "stage5_checks::fresnel::exact in stage5_recursion::fresnel_exact",
    // The slide's one-line formula in double precision.
    "stage5_checks::fresnel::schlick in stage5_recursion::fresnel_schlick",
    // The slide's one-line formula in double precision.
    "stage8_checks::spaces::normal in stage8_scene_graph::normal_to_world",
];

/// The crates that students receive: where their sources are, and what other crates call them.
fn crates() -> Vec<(String, String)> {
    let shared = [
        ("src", "raykata"),
        ("tests/oracle/src", "oracle"),
        ("tests/checks/src", "checks"),
        ("tests/checks/all/src", "all_checks"),
    ];
    let stages =
        (1..=12).map(|stage| (format!("tests/checks/stage{stage}/src"), format!("stage{stage}_checks")));
    let named =
        shared.iter().chain(&PROGRAMS).map(|(folder, name)| ((*folder).to_owned(), (*name).to_owned()));
    named.chain(stages).collect()
}

/// The programs that students receive. The copy does not build them, because they and their dependencies would take most of
/// its time. So no exercise can call their functions, and none of these may fit an exercise.
const PROGRAMS: [(&str, &str); 3] =
    [("src/cli/src", "raykata_cli"), ("tests/judge/src", "judge"), ("src/live/src", "live")];

/// Returns whether a function belongs to one of the programs.
fn is_of_a_program(function: &Function) -> bool {
    PROGRAMS.iter().any(|(_, name)| function.path.starts_with(&format!("{name}::")))
}

/// Returns the functions of those crates, in the kit or in a copy of it. A copy has no programs, so they are always those of
/// the kit.
fn handed_out(copy: &Path) -> Vec<Function> {
    let (kit, bundles) = (root(), bundles(copy));
    let of_crate = |(folder, name): &(String, String)| {
        let is_program = PROGRAMS.iter().any(|(_, program)| program == name);
        functions(if is_program { &kit } else { copy }, folder, name, &bundles)
    };
    crates().iter().flat_map(of_crate).collect()
}

/// Returns the functions that students write.
fn exercises(root: &Path) -> Vec<Function> {
    let texts = exercises::pristine(root).expect("readable solutions");
    let (mut exercises, bundles) = (Vec::new(), bundles(root));
    for (name, text) in texts.iter().filter(|(name, _)| name.starts_with("stage")) {
        let (file, module) = (format!("solutions/src/{name}"), name.trim_end_matches(".rs"));
        exercises.extend(functions_of(&file, module, text, &bundles));
    }
    exercises.retain(|function| function.is_exercise);
    exercises
}

/// Returns the prefix of the names of the checks of an exercise's stage.
fn stage(exercise: &Function) -> String {
    format!("{}::", exercise.path.split('_').next().unwrap_or_default())
}

/// Two planted answers, which the test must find: the file, the path for other crates, the text and the exercise.
const PLANTED: [(&str, &str, &str, &str); 2] = [
    (
        "tests/checks/src/tree/mod.rs",
        "checks::tree::planted_area",
        "\npub fn planted_area(of: Aabb) -> f64 {\n    2.0 * half_area(&of)\n}\n",
        "stage3_boxes::surface_area",
    ),
    (
        "tests/checks/stage4/src/gamma.rs",
        "stage4_checks::gamma::planted_byte",
        "\nfn planted_byte(linear: f64) -> u8 {\n    (255.0 * linear.clamp(0.0, 1.0).sqrt() + 0.5) as u8\n}\n",
        "stage4_shading::encode_gamma",
    ),
];

#[test]
fn what_fits_an_exercise_is_recorded() {
    let root = root();
    let (exercises, all) = (exercises(&root), handed_out(&root));
    let (n_exercises, n_functions) = (exercises.len(), all.len());
    assert!(n_exercises > 100 && n_functions > 1400, "{n_exercises} exercises, {n_functions} functions");
    let fitting = candidates(&exercises, &all);
    let line =
        |(exercise, function): &(&Function, &Function)| format!("{} in {}", function.path, exercise.path);
    let mut lines: BTreeSet<String> = fitting.iter().map(line).collect();
    for (folder, name) in PROGRAMS {
        assert!(all.iter().filter(|function| function.file.starts_with(folder)).count() > 10, "{folder}");
        if !fitting.iter().any(|(_, function)| function.file.starts_with(folder)) {
            lines.insert(format!("{name}: no function fits"));
        }
    }
    insta::with_settings!({ snapshot_path => "paste", prepend_module_to_snapshot => false, omit_expression => true }, {
        insta::assert_snapshot!("candidates", lines.into_iter().collect::<Vec<_>>().join("\n"));
    });
}

#[test]
fn a_planted_answer_fits() {
    let exercises = exercises(&root());
    for (file, path, text, exercise) in PLANTED {
        let module = path.rsplit_once("::").expect("a module").0;
        let planted = functions_of(file, module, text, &bundles(&root()));
        let found = candidates(&exercises, &planted);
        assert!(found.iter().any(|(found, one)| found.path == exercise && one.path == path), "{path}");
    }
}

#[test]
fn no_function_that_students_receive_is_an_answer() {
    if leaves_out_what_takes_long() {
        return;
    }
    let (root, folder) = (root(), root().join("target/paste"));
    let open: Vec<String> = crates().into_iter().map(|(folder, _)| folder).collect();
    copy::copy(&root, &folder, &open);
    for (file, _, text, _) in PLANTED {
        copy::append(&folder.join(file), &text.replace("\nfn ", "\npub fn "));
    }
    let (exercises, all, bundles) = (exercises(&root), handed_out(&folder), bundles(&root));
    let mut pasted: Vec<(&Function, &Function)> = Vec::new();
    let mut arms: BTreeMap<(&str, &str), String> = BTreeMap::new();
    let mut answers = BTreeSet::new();
    for (exercise, function) in candidates(&exercises, &all) {
        let mut calls = call::calls(exercise, function, &bundles);
        if is_of_a_program(function) {
            calls.clear();
        }
        if calls.is_empty() {
            // Skip functions that other crates cannot call. Only a person can judge these.
            answers.insert(format!("{} in {}", function.path, exercise.path));
        }
        for call in calls {
            pasted.push((exercise, function));
            let name = exercise.path.rsplit("::").next().unwrap_or_default();
            let arm = format!("        {} => return {call},\n", pasted.len());
            *arms.entry((&exercise.file, name)).or_default() += &arm;
        }
    }
    for ((file, name), arms) in arms {
        let code = format!("\n    match crate::pasted() {{\n{arms}        _ => {{}}\n    }}\n");
        copy::insert(&folder.join(file), name, &code);
    }
    copy::append(
        &folder.join("solutions/src/lib.rs"),
        "\n/// Which function answers in place of an exercise.\npub fn pasted() -> usize {\n    \
         static PASTED: std::sync::LazyLock<usize> = std::sync::LazyLock::new(|| {\n        \
         std::env::var(\"PASTE\").ok().and_then(|number| number.parse().ok()).unwrap_or(0)\n    });\n    \
         *PASTED\n}\n",
    );
    let program = copy::build(&folder);
    assert!(copy::passes(&program, &folder, "stage", 0), "the unchanged copy fails");
    for (index, (exercise, function)) in pasted.iter().enumerate() {
        if copy::passes(&program, &folder, &stage(exercise), index + 1) {
            answers.insert(format!("{} in {}", function.path, exercise.path));
        }
    }
    let known = EXCEPTIONS.iter().map(|&known| known.to_owned());
    let planted = PLANTED.iter().map(|(_, path, _, exercise)| format!("{path} in {exercise}"));
    let expected: BTreeSet<String> = known.chain(planted).collect();
    assert_eq!(answers, expected, "answers that students receive, and the planted ones");
}
