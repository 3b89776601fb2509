//! Check that the ignored advisories in `deny.toml` concern packages that are in `Cargo.lock`.

use std::collections::BTreeSet;

/// Names of the packages in the lock file.
fn packages() -> BTreeSet<&'static str> {
    let lines = include_str!("../../Cargo.lock").lines();
    lines.filter_map(|line| line.strip_prefix("name = \"")?.strip_suffix('"')).collect()
}

#[test]
fn advisories_that_are_passed_over_concern_packages_that_are_used() {
    let deny = include_str!("../../deny.toml");
    let entries = deny.lines().filter(|line| line.trim_start().starts_with("{ id = \"RUSTSEC-"));
    let reasons: Vec<_> = entries.filter_map(|line| line.split("reason = \"").nth(1)).collect();
    assert!(!reasons.is_empty(), "the check must see the entries");
    let packages = packages();
    for reason in &reasons {
        let package = reason.split_whitespace().next().unwrap_or_default();
        assert!(packages.contains(package), "{package} is not in Cargo.lock: {reason}");
    }
    // It is unmaintained, and needs an entry for as long as it is used.
    let has_entry = reasons.iter().any(|reason| reason.starts_with("ttf-parser "));
    assert_eq!(has_entry, packages.contains("ttf-parser"));
}
