//! Incomplete recordings: pages or files are missing because it was stopped, or because one of its files is missing.

/// Wording of the remarks on missing slices: the pictures that slices are made of, and the claim that there are more.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GapWords {
    /// Plural name of the pictures, such as pages.
    pub(crate) pictures: &'static str,
    /// Continuation of "4 slices" that tells why so many are expected.
    pub(crate) claim: &'static str,
}

/// Wording for pages that the metadata of a file announce.
pub(crate) const ANNOUNCED_PAGES: GapWords = GapWords { pictures: "pages", claim: "are announced" };

/// Slices of a recording that are shown, with a remark on the missing ones.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct SliceRun<T> {
    /// Slices from the first that has a picture to the last; gaps in between are empty.
    pub(crate) slices: Vec<Option<T>>,
    pub(crate) remark: Option<String>,
}

impl<T: Clone> SliceRun<T> {
    /// Creates a run from slices some of which lack a picture; `None` where none has one.
    pub(crate) fn new(slices: &[Option<T>], words: GapWords) -> Option<Self> {
        let GapWords { pictures, claim } = words;
        let first = slices.iter().position(Option::is_some)?;
        let last = slices.iter().rposition(Option::is_some)?;
        let kept = slices[first..=last].to_vec();
        let (said, there) = (slices.len(), kept.len());
        let mut parts = Vec::new();
        if there < said {
            parts.push(if first == 0 {
                format!("{said} slices {claim}, and there are {pictures} for the first {there}: those are shown")
            } else {
                format!(
                    "{said} slices {claim}, and there are {pictures} for {first} to {last} of them: those are shown"
                )
            });
        }
        let empty: Vec<usize> = (first..=last).filter(|&at| slices[at].is_none()).collect();
        if !empty.is_empty() {
            parts.push(format!(
                "no {pictures} exist for slices {}: they are left empty",
                list_numbers(&empty)
            ));
        }
        let remark = (!parts.is_empty()).then(|| parts.join("; "));
        Some(Self { slices: kept, remark })
    }
}

/// Lists numbers as text, shortened where there are many.
fn list_numbers(numbers: &[usize]) -> String {
    // As many as fit into a line.
    const MOST: usize = 8;
    let mut words: Vec<String> = numbers.iter().take(MOST).map(usize::to_string).collect();
    if numbers.len() > MOST {
        words.push(format!("and {} more", numbers.len() - MOST));
    }
    words.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_left_out_and_gaps_between_stay() {
        let slices = |pages: &[i32]| -> Vec<Option<usize>> {
            pages.iter().map(|&page| usize::try_from(page).ok()).collect()
        };
        let recorded = |pages: &[i32]| SliceRun::new(&slices(pages), ANNOUNCED_PAGES);
        assert_eq!(recorded(&[-1, -1]), None);
        assert_eq!(recorded(&[0, 1]), Some(SliceRun { slices: slices(&[0, 1]), remark: None }));
        let stopped = recorded(&[0, 1, -1, -1]).unwrap();
        assert_eq!(stopped.slices, slices(&[0, 1]));
        assert!(
            stopped.remark.unwrap().contains("4 slices are announced, and there are pages for the first 2")
        );
        let between = recorded(&[-1, 5, -1, 7, -1]).unwrap();
        assert_eq!(between.slices, slices(&[5, -1, 7]));
        let remark = between.remark.unwrap();
        assert!(
            remark.contains("for 1 to 3 of them") && remark.contains("slices 2: they are left empty"),
            "{remark}"
        );
        let many: Vec<i32> = (0..40).map(|at| if at % 2 == 0 { at } else { -1 }).collect();
        assert!(recorded(&many).unwrap().remark.unwrap().contains("13, 15, and 11 more"));
    }
}
