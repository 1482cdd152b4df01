//! Finds the numbers by which checks judge: those that are compared, and the factors of values that are compared. A number that is
//! added or given to a function is a part of a formula and no bound.

use anyhow::{Result, anyhow};
use std::collections::BTreeSet;
use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

/// A number of a check, and the comparison in which it stands, if it stands in one.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// Its bytes in the file.
    pub place: Range<usize>,
    /// Whether it has no fraction.
    pub is_whole: bool,
    /// The bytes of the sign of the comparison.
    pub comparison: Option<Range<usize>>,
}

impl Number {
    /// The text of the file with ten times the number.
    pub fn times_ten(&self, text: &str) -> String {
        let ten = if self.is_whole { "10" } else { "10.0" };
        let mut changed = text.to_owned();
        changed.replace_range(self.place.clone(), &format!("({ten} * {})", &text[self.place.clone()]));
        changed
    }

    /// The text of the file with the comparison turned, if there is one.
    pub fn turned(&self, text: &str) -> Option<String> {
        let place = self.comparison.clone()?;
        let turned = match &text[place.clone()] {
            "<" => ">",
            "<=" => ">=",
            ">" => "<",
            _ => "<=",
        };
        let mut changed = text.to_owned();
        changed.replace_range(place, turned);
        Some(changed)
    }
}

/// Finds the numbers of a file, in order. Zero is none, because ten times zero is zero.
pub fn numbers(text: &str) -> Result<Vec<Number>> {
    let file = syn::parse_file(text).map_err(|error| anyhow!("{error}"))?;
    let mut compared = Compared::default();
    compared.visit_file(&file);
    let mut finder = Finder { compared: compared.0, found: Vec::new() };
    finder.visit_file(&file);
    Ok(finder.found)
}

/// The sign of a comparison.
fn sign(op: &syn::BinOp) -> Option<Range<usize>> {
    use syn::BinOp::{Ge, Gt, Le, Lt};
    matches!(op, Lt(_) | Le(_) | Gt(_) | Ge(_)).then(|| op.span().byte_range())
}

/// Whether an item is compiled for tests only.
fn is_for_tests(attrs: &[syn::Attribute]) -> bool {
    attrs.iter().any(|attr| attr.path().is_ident("cfg") || attr.path().is_ident("test"))
}

/// The names of what is compared.
#[derive(Default)]
struct Compared(BTreeSet<String>);

impl<'ast> Visit<'ast> for Compared {
    fn visit_expr_binary(&mut self, binary: &'ast syn::ExprBinary) {
        if sign(&binary.op).is_some() {
            let mut names = Names(&mut self.0);
            names.visit_expr(&binary.left);
            names.visit_expr(&binary.right);
        }
        visit::visit_expr_binary(self, binary);
    }
}

struct Names<'a>(&'a mut BTreeSet<String>);

impl<'ast> Visit<'ast> for Names<'_> {
    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.0.extend(path.segments.last().map(|segment| segment.ident.to_string()));
        visit::visit_path(self, path);
    }
}

struct Finder {
    compared: BTreeSet<String>,
    found: Vec<Number>,
}

impl Finder {
    /// Adds the numbers that are factors of a value.
    fn factors(&mut self, value: &syn::Expr, comparison: &Option<Range<usize>>) {
        match value {
            syn::Expr::Lit(literal) => self.number(literal, comparison),
            syn::Expr::Binary(binary) if matches!(binary.op, syn::BinOp::Mul(_) | syn::BinOp::Div(_)) => {
                self.factors(&binary.left, comparison);
                self.factors(&binary.right, comparison);
            }
            syn::Expr::Paren(inner) => self.factors(&inner.expr, comparison),
            syn::Expr::Unary(inner) => self.factors(&inner.expr, comparison),
            syn::Expr::Cast(inner) => self.factors(&inner.expr, comparison),
            _ => {}
        }
    }

    fn number(&mut self, literal: &syn::ExprLit, comparison: &Option<Range<usize>>) {
        let is_zero = |digits: &str| digits.parse::<f64>().is_ok_and(|value| value == 0.0);
        let is_whole = match &literal.lit {
            syn::Lit::Int(number) if !is_zero(number.base10_digits()) => true,
            syn::Lit::Float(number) if !is_zero(number.base10_digits()) => false,
            _ => return,
        };
        let place = literal.span().byte_range();
        self.found.push(Number { place, is_whole, comparison: comparison.clone() });
    }
}

impl<'ast> Visit<'ast> for Finder {
    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        if !is_for_tests(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_item_const(&mut self, item: &'ast syn::ItemConst) {
        if self.compared.contains(&item.ident.to_string()) {
            self.factors(&item.expr, &None);
        }
        visit::visit_item_const(self, item);
    }

    fn visit_local(&mut self, local: &'ast syn::Local) {
        if let (syn::Pat::Ident(name), Some(init)) = (&local.pat, &local.init)
            && self.compared.contains(&name.ident.to_string())
        {
            self.factors(&init.expr, &None);
        }
        visit::visit_local(self, local);
    }

    fn visit_expr_binary(&mut self, binary: &'ast syn::ExprBinary) {
        if let Some(sign) = sign(&binary.op) {
            self.factors(&binary.left, &Some(sign.clone()));
            self.factors(&binary.right, &Some(sign));
        }
        visit::visit_expr_binary(self, binary);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_are_compared_are_found() {
        let text = "const BOUND: f64 = 1e-3;\nconst OTHER: f64 = 7.0;\nfn f(x: f64, v: &[f64]) -> bool {\n    let most = 4 * x as u32;\n    \
                    let other = 5.0;\n    v[1] < 0.0 || (x - other).abs() > BOUND && x <= 2.5 * other.max(v[2]) && most > 3\n}\n\
                    #[cfg(test)]\nmod tests { const N: f64 = 9.0; fn g() -> bool { N > 8.0 } }\n";
        let found = numbers(text).unwrap();
        let words: Vec<&str> = found.iter().map(|number| &text[number.place.clone()]).collect();
        assert_eq!(words, ["1e-3", "4", "5.0", "2.5", "3"]);
        assert!(found[0].times_ten(text).starts_with("const BOUND: f64 = (10.0 * 1e-3);"));
        assert!(found[1].times_ten(text).contains("let most = (10 * 4) * x"));
        assert_eq!(found[0].turned(text), None);
        assert!(found[3].turned(text).unwrap().contains("x >= 2.5 *"));
        assert!(found[4].turned(text).unwrap().contains("most < 3"));
    }
}
