//! Physics whose answer is known, measured on this machine: a table of checks, each a scene and what
//! it must show.

mod adding;
mod closed;
mod enclosure;
mod energy;
mod finding;
mod furnace;
mod measured;
mod reciprocity;
mod threads;
mod translation;
mod turbid;

use std::fmt::Write as _;
use std::time::Instant;
use sunfleck::counts::counted;

use serde_json::json;

use finding::Finding;

/// A claim about the program, and how it is put to the test.
#[derive(Clone, Copy)]
pub(crate) struct Check {
    /// Name for `--only`.
    pub(crate) name: &'static str,
    /// Statement that must hold, and its reason.
    statement: &'static str,
    /// Measures it.
    run: fn() -> anyhow::Result<Vec<Finding>>,
}

/// All checks, the quickest first.
pub(crate) const CHECKS: [Check; 9] = [
    Check {
        name: "closed",
        statement: "planes, slopes, plates, shadows and view factors have their closed forms",
        run: closed::run,
    },
    Check {
        name: "adding",
        statement: "horizontal leaf sheets reflect, transmit and absorb as adding of layers says",
        run: adding::run,
    },
    Check {
        name: "energy",
        statement: "all energy that comes in is reflected, lost, absorbed or taken by roulette",
        run: energy::run,
    },
    Check {
        name: "furnace",
        statement: "what absorbs nothing looks like the isotropic sky above it, and has albedo 1",
        run: furnace::run,
    },
    Check {
        name: "reciprocity",
        statement: "a periodic scene has the same BRF with sun and view swapped",
        run: reciprocity::run,
    },
    Check {
        name: "turbid",
        statement: "a layer of small leaves obeys Beer's law and the radiative transfer equation",
        run: turbid::run,
    },
    Check {
        name: "enclosure",
        statement: "an isothermal enclosure is a black body whatever its walls",
        run: enclosure::run,
    },
    Check {
        name: "translation",
        statement: "a scene measures the same a thousand kilometres away",
        run: translation::run,
    },
    Check {
        name: "threads",
        statement: "any number of threads gives the same bits",
        run: threads::run,
    },
];

/// Result of a check.
struct Outcome {
    check: Check,
    findings: anyhow::Result<Vec<Finding>>,
    seconds: f64,
}

impl Outcome {
    fn new(check: Check) -> Self {
        let start = Instant::now();
        let findings = (check.run)();
        Self { check, findings, seconds: start.elapsed().as_secs_f64() }
    }

    fn passes(&self) -> bool {
        self.findings.as_ref().is_ok_and(|all| !all.is_empty() && all.iter().all(Finding::holds))
    }

    fn verdict(&self) -> &'static str {
        verdict(self.passes())
    }

    fn text(&self) -> anyhow::Result<String> {
        let mut text = format!("{}: {}\n", self.check.name, self.check.statement);
        match &self.findings {
            Ok(findings) => {
                let width = findings.iter().map(|one| one.quantity.chars().count()).max();
                for one in findings {
                    writeln!(text, "  {} {}", verdict(one.holds()), one.line(width.unwrap_or(0)))?;
                }
            }
            Err(error) => writeln!(text, "  {error:#}")?,
        }
        writeln!(text, "  {} in {:.1} s\n", self.verdict(), self.seconds)?;
        Ok(text)
    }

    fn json(&self) -> serde_json::Value {
        json!({
            "name": self.check.name,
            "statement": self.check.statement,
            "passes": self.passes(),
            "seconds": self.seconds,
            "error": self.findings.as_ref().err().map(|error| format!("{error:#}")),
            "findings": self.findings.iter().flatten().map(Finding::json).collect::<Vec<_>>(),
        })
    }
}

fn verdict(passes: bool) -> &'static str {
    if passes { "pass" } else { "FAIL" }
}

/// Runs the checks of these names, all if there are none, and shows each as it ends; whether all
/// passed.
pub(crate) fn verify(
    names: &[String],
    as_json: bool,
    show: impl Fn(&str) -> anyhow::Result<()>,
) -> anyhow::Result<bool> {
    let wanted = |check: &&Check| names.is_empty() || names.iter().any(|name| name == check.name);
    let start = Instant::now();
    let mut outcomes = Vec::new();
    for &check in CHECKS.iter().filter(wanted) {
        let outcome = Outcome::new(check);
        if !as_json {
            show(&outcome.text()?)?;
        }
        outcomes.push(outcome);
    }
    let (seconds, failed) = (start.elapsed().as_secs_f64(), failures(&outcomes));
    if as_json {
        let checks: Vec<_> = outcomes.iter().map(Outcome::json).collect();
        let report = json!({
            "version": env!("CARGO_PKG_VERSION"),
            "passes": failed.is_empty(),
            "seconds": seconds,
            "checks": checks,
        });
        show(&format!("{report:#}\n"))?;
    } else if failed.is_empty() {
        show(&format!("{} passed in {seconds:.1} s\n", counted(outcomes.len(), "check")))?;
    } else {
        show(&format!("failed: {}; {seconds:.1} s in all\n", failed.join(", ")))?;
    }
    Ok(failed.is_empty())
}

fn failures(outcomes: &[Outcome]) -> Vec<&'static str> {
    outcomes.iter().filter(|one| !one.passes()).map(|one| one.check.name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(findings: anyhow::Result<Vec<Finding>>) -> Outcome {
        Outcome { check: CHECKS[0], findings, seconds: 1.0 }
    }

    #[test]
    fn a_check_passes_if_it_finds_something_and_all_of_it_holds() {
        let (good, bad) = (|| Finding::exact("a", 1.0, 1.0), || Finding::exact("a", 1.0, 1.5));
        assert!(outcome(Ok(vec![good(), good()])).passes());
        assert!(!outcome(Ok(vec![good(), bad()])).passes());
        assert!(!outcome(Ok(Vec::new())).passes());
        let broken = outcome(Err(anyhow::anyhow!("no such sensor")));
        assert!(!broken.passes());
        assert!(broken.text().is_ok_and(|text| text.contains("no such sensor")));
    }

    #[test]
    fn names_are_different() {
        for (index, check) in CHECKS.iter().enumerate() {
            assert!(CHECKS[..index].iter().all(|other| other.name != check.name), "{}", check.name);
        }
    }
}
